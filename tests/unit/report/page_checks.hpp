// What every page must hold to, for the tests of the report.
#pragma once

#include <string>

namespace qsmpc::testing {

/// The first thing that is wrong with the tags of `html` (one that is closed without having been
/// opened, or the other way round, or a bare '<' or quote); empty if they are in order.
[[nodiscard]] std::string tag_problem(const std::string& html);

/// Whether `part` occurs in `text`; unlike a matcher, it does not print a whole page on failure.
[[nodiscard]] bool contains(const std::string& text, const std::string& part);

/// How often `part` occurs in `text`.
[[nodiscard]] int occurrences(const std::string& text, const std::string& part);

}  // namespace qsmpc::testing
