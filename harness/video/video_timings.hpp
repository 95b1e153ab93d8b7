// The cost and the properties of a video, for the terminal and the report.
#pragma once

#include <string>

#pragma GCC visibility push(default)

namespace qsmpc::harness {

/// Times are wall-clock times, so they are longer if other work shares the processor.
struct VideoTimings {
  int frames = 0;
  int fps = 0;                 ///< frames per second when played
  double from = 0.0;           ///< time of the episode at which the video begins, s
  double speed = 1.0;          ///< seconds of the episode per second of video
  int width = 0;               ///< pixels
  int height = 0;              ///< pixels
  std::string codec{};         ///< as ffprobe names it, e.g. "h264"
  double wall_s = 0.0;         ///< from the start of the first frame to the finished file, s
  double drawing_ms = 0.0;     ///< per frame in one drawing thread, ms; threads draw in parallel
  double encoding_ms = 0.0;    ///< thread time per frame for conversion and encoder, ms
  double simulation_ms = 0.0;  ///< time of the plant per control period during the drive, ms
  std::string gl = {};         ///< OpenGL's version and renderer

  /// Duration of the finished video when played, s.
  [[nodiscard]] double seconds() const;

  /// Frames produced per second of wall-clock time; 0 if no time passed.
  [[nodiscard]] double frames_per_second() const;
};

/// One line for a terminal, e.g. "video: 523 frames in 9.1 s (57 frames/s; drawing 21 ms, encoding
/// 9 ms a frame)".
[[nodiscard]] std::string video_line(const VideoTimings& timings);

/// The keys documented in docs/video.md as JSON, ending in a newline.
[[nodiscard]] std::string video_json(const VideoTimings& timings);

/// Reads what `video_json` wrote from the file at `path`. Throws InputError.
[[nodiscard]] VideoTimings read_video_timings(const std::string& path);

}  // namespace qsmpc::harness

#pragma GCC visibility pop
