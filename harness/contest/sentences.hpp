// What a contest's numbers say, in words.
#pragma once

#include <cstddef>
#include <string>

#include "harness/contest/standings.hpp"

namespace qsmpc::harness {

/// Who has the fewest unsafe drives, and who the lowest cost, in a line.
[[nodiscard]] std::string contest_headline(const ContestResults& results);

/// What is to be said of a controller, without its name: of the reference what it did, of others
/// where they are ahead of it, behind, or not to be told apart from it. Plain text.
[[nodiscard]] std::string words_about(const ContestResults& results, std::size_t controller);

}  // namespace qsmpc::harness
