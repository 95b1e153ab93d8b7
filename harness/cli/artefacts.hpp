// What is made from a trace, beside it in the same folder; shared by `run`, `render` and `report`.
#pragma once

#include <string>

#include "harness/trace/trace.hpp"
#include "harness/video/episode_video.hpp"

namespace qsmpc {

inline constexpr const char* kSummaryFile = "summary.json";
inline constexpr const char* kVideoFile = "episode.mp4";
inline constexpr const char* kPageFile = "report.html";

/// Removes the summary, video and page in `folder`. Throws IoError.
void discard_artefacts(const std::string& folder);

/// What the scenario says of its video.
[[nodiscard]] EpisodeVideoOptions video_options(const Scenario& scenario);

/// Renders the video with a progress bar; a second Ctrl-C ends it early and keeps what is rendered.
/// Throws IoError.
void make_video(const Trace& trace, const std::string& folder, const EpisodeVideoOptions& options,
                bool quiet);

/// Writes summary.json. Throws IoError.
void write_summary(const Trace& trace, const std::string& folder, bool with_video);

/// Writes report.html. Throws IoError.
void write_page(const Trace& trace, const std::string& folder, bool with_video);

/// The summary as a table for a terminal, with the paths of the files.
[[nodiscard]] std::string summary_table(const Trace& trace, const std::string& folder,
                                        bool with_video);

/// Reads the trace in `folder`, or its partial file where an episode was killed. Throws InputError.
[[nodiscard]] Trace read_folder(const std::string& folder);

}  // namespace qsmpc
