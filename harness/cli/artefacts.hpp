// Files made from a trace in its folder; shared by `run`, `render` and `report`.
#pragma once

#include <string>

#include "harness/trace/episode_view.hpp"
#include "harness/trace/trace.hpp"
#include "harness/video/episode_video.hpp"

namespace qsmpc::harness {

inline constexpr const char* kSummaryFile = "summary.json";
inline constexpr const char* kVideoFile = "episode.mp4";
inline constexpr const char* kVideoNumbersFile = "video.json";
inline constexpr const char* kPageFile = "report.html";

/// Removes the summary, videos and page in `folder`. Throws IoError.
void discard_artefacts(const std::string& folder);

/// Draws with the OpenGL library of this name (see gl_names) from now on. Throws IoError if it is
/// not available.
void choose_gl(const std::string& name);

/// Why nothing can be drawn on this machine; empty if drawing works.
[[nodiscard]] std::string why_no_gl();

/// Throws IoError if the process's limit leaves too little address space to draw with `options`. To
/// be called before anything is drawn and before `choose_gl` and `why_no_gl`.
void refuse_without_memory_to_draw(const EpisodeVideoOptions& options);

/// The video options in the scenario.
[[nodiscard]] EpisodeVideoOptions video_options(const Scenario& scenario);

struct VideoFiles {
  std::string video;
  std::string numbers;  ///< the video's size, length and cost as JSON
};

struct VideoTalk {
  bool quiet = false;    ///< suppresses progress
  bool verbose = false;  ///< reports on standard error what drew, and how fast
};

/// Renders the video with a progress bar. An interrupt ends it early: an existing video is kept,
/// otherwise the frames rendered so far become the video; a line on standard error says which.
/// Returns whether the whole video was rendered. Throws IoError.
bool make_video(const EpisodeView& view, const VideoFiles& files,
                const EpisodeVideoOptions& options, const VideoTalk& talk);

/// Renders the picture at `time` (s) into the PNG file at `path`. Throws IoError.
void make_still(const EpisodeView& view, const std::string& path,
                const EpisodeVideoOptions& options, double time, const VideoTalk& talk);

/// Writes summary.json. Throws IoError.
void write_summary(const EpisodeView& view, const std::string& folder, bool with_video);

/// Writes report.html. Throws IoError.
void write_page(const EpisodeView& view, const std::string& folder, bool with_video);

/// The summary as a table for a terminal, with the paths of the files.
[[nodiscard]] std::string summary_table(const EpisodeView& view, const std::string& folder,
                                        bool with_video);

}  // namespace qsmpc::harness
