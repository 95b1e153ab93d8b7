// What every page begins and ends with.
#pragma once

#include <string>

namespace qsmpc::harness {

enum class PageScripts {
  kNone,     ///< the page runs nothing
  kEpisode,  ///< it ends with page_scripts()
};

/// From the doctype to the start of the body: title, style, and a policy by which the page loads
/// nothing but a video beside it and uses no style and no script but the one that it came with.
[[nodiscard]] std::string page_head(const std::string& title,
                                    PageScripts scripts = PageScripts::kNone);

/// The scripts, which go before the end of the body of a page whose head allows them.
[[nodiscard]] std::string page_scripts();

/// The footer, which says which version made the page, and the end of the body.
[[nodiscard]] std::string page_foot(const std::string& version);

}  // namespace qsmpc::harness
