// A contest's results in words.
#pragma once

#include <cstddef>
#include <string>

#include "harness/contest/standings.hpp"

namespace qsmpc::harness {

/// One line: which controller has the fewest unsafe drives, and which the lowest cost.
[[nodiscard]] std::string contest_headline(const ContestResults& results);

/// A summary of a controller, without its name, as plain text: of the reference what it did; of the
/// others where they are ahead of it, behind it, or indistinguishable from it.
[[nodiscard]] std::string words_about(const ContestResults& results, std::size_t controller);

}  // namespace qsmpc::harness
