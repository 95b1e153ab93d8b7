// Checks that every page must pass, for the tests of the report.
#pragma once

#include <string>

namespace qsmpc::testing {

/// The first problem with the tags of `html` (a tag closed without having been opened or the
/// reverse, or a bare '<' or quote); empty if there is none.
[[nodiscard]] std::string tag_problem(const std::string& html);

/// Whether `part` occurs in `text`; unlike a matcher, it does not print a whole page on failure.
[[nodiscard]] bool contains(const std::string& text, const std::string& part);

/// How often `part` occurs in `text`.
[[nodiscard]] int occurrences(const std::string& text, const std::string& part);

}  // namespace qsmpc::testing
