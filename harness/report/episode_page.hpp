// The report of one episode: one HTML page that needs only itself and the video beside it.
//
//   write_file(folder + "/report.html", episode_page(trace, {.video_file = "episode.mp4"}));
//
// The page loads nothing from a network; its policy forbids that and every script but its own
// (web/), which replay the drive with a slider. Drawings, tables and video also work without
// scripts. Texts of the scenario are escaped.
#pragma once

#include <string>

#include "harness/trace/episode_view.hpp"

namespace qsmpc::harness {

struct EpisodePageOptions {
  std::string video_file{};  ///< in the folder of the page; empty: none
  std::string video_note{};  ///< shown below it, e.g. how long it took
  double video_from = 0.0;   ///< time of the drive at which the video begins, s
  double video_speed = 1.0;  ///< seconds of the drive per second of video
};

/// The page as UTF-8 text. A trace without steps gives a page that says why. Throws
/// std::invalid_argument if the trace's system is unknown.
[[nodiscard]] std::string episode_page(const EpisodeView& view, const EpisodePageOptions& options);

}  // namespace qsmpc::harness
