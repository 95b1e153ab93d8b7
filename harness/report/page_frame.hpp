// The beginning and end of every page.
#pragma once

#include <string>

namespace qsmpc::harness {

enum class PageKind {
  kPlain,         ///< runs no script
  kTables,        ///< as kPlain, with the style of tables, also in print
  kEpisode,       ///< ends with the scripts of an episode's page
  kEpisodeScene,  ///< ends with these and that of its three-dimensional view
};

struct PageFrame {
  std::string title;
  std::string version;  ///< that generated the page
  PageKind kind = PageKind::kPlain;
};

/// The page around `body`, which is HTML: title, style, and a policy that lets the page load only a
/// video beside it and use only its own style and scripts; at its end the scripts, and a footer
/// with the version that made it.
[[nodiscard]] std::string framed_page(const PageFrame& frame, const std::string& body);

}  // namespace qsmpc::harness
