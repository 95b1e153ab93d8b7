// What making a video cost, and what came out: for people who wait for it and for the report.
#pragma once

#include <string>

#pragma GCC visibility push(default)

namespace qsmpc::harness {

/// Times are wall-clock times, so that they are longer where other work shares the processor.
struct VideoTimings {
  int frames = 0;
  int fps = 0;                 ///< frames a second when played
  double from = 0.0;           ///< s of the episode, where the video begins
  double speed = 1.0;          ///< s of the episode in a second of the video
  int width = 0;               ///< pixels
  int height = 0;              ///< pixels
  std::string codec{};         ///< as ffprobe names it, e.g. "h264"
  double wall_s = 0.0;         ///< s, from the first frame's beginning to the finished file
  double drawing_ms = 0.0;     ///< ms a frame in a thread that draws; threads draw side by side
  double encoding_ms = 0.0;    ///< ms a frame that conversion and encoder keep their thread
  double simulation_ms = 0.0;  ///< ms a control period, what the plant took when it was driven
  std::string gl = {};         ///< what drew: OpenGL's version and renderer

  /// s of the finished video when played.
  [[nodiscard]] double seconds() const;

  /// How many frames were made in a second; 0 when no time passed.
  [[nodiscard]] double frames_per_second() const;
};

/// One line for a terminal, e.g. "video: 523 frames in 9.1 s (57 frames/s; drawing 21 ms, encoding
/// 9 ms a frame)".
[[nodiscard]] std::string video_line(const VideoTimings& timings);

/// The keys documented in docs/video.md, ending with a line break.
[[nodiscard]] std::string video_json(const VideoTimings& timings);

/// What `video_json` wrote into the file at `path`. Throws InputError.
[[nodiscard]] VideoTimings read_video_timings(const std::string& path);

}  // namespace qsmpc::harness

#pragma GCC visibility pop
