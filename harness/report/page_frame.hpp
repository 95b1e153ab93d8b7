// What every page begins and ends with.
#pragma once

#include <string>

namespace qsmpc::harness {

enum class PageKind {
  kPlain,         ///< it runs nothing
  kTables,        ///< the same, with the style of tables, on paper too
  kEpisode,       ///< it ends with the scripts of an episode's page
  kEpisodeScene,  ///< with these and the one of its view in three dimensions
};

struct PageFrame {
  std::string title;
  std::string version;  ///< that made the page
  PageKind kind = PageKind::kPlain;
};

/// The page about `body`, which is HTML: title, style, and a policy by which the page loads nothing
/// but a video beside it and uses no style and no script but the one that it came with; at its end
/// the scripts, and a footer that says which version made it.
[[nodiscard]] std::string framed_page(const PageFrame& frame, const std::string& body);

}  // namespace qsmpc::harness
