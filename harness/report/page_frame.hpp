// What every page begins and ends with.
#pragma once

#include <string>

namespace qsmpc {

/// From the doctype to the start of the body: title, style, and a policy by which the page loads
/// nothing but a video beside it.
[[nodiscard]] std::string page_head(const std::string& title);

/// The footer, which says which version made the page, and the end of the body.
[[nodiscard]] std::string page_foot(const std::string& version);

}  // namespace qsmpc
