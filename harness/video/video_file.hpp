// Crash-safe video files: at any time, the requested name holds either a complete file or none, and
// a playable partial file stands beside it.
//
//   qsmpc::harness::VideoFile video("a.mp4", {.width = 1280, .height = 720, .frames_per_second =
//   30}); for (…) { renderer.draw(frame, image); video.add(image); } video.finish();
#pragma once

#include <memory>
#include <string>

#include "render/frame.hpp"
#include "render/media/video_writer.hpp"

namespace qsmpc::harness {

/// Writes PATH.partial, which stays playable if the process is killed, and turns it into PATH at
/// the end. Failed writes throw IoError with the file's path and the system's message.
class VideoFile {
 public:
  /// `settings.name` becomes `path`. Throws like VideoWriter, and IoError. PATH.partial is created
  /// only after the settings have been validated.
  VideoFile(std::string path, render::VideoSettings settings);

  /// Without `finish` nothing is written under the final name; PATH.partial keeps what was added.
  ~VideoFile();
  VideoFile(const VideoFile&) = delete;
  VideoFile& operator=(const VideoFile&) = delete;

  /// Adds the next frame. Throws like VideoWriter, and IoError.
  void add(const render::Image& image);

  /// Writes PATH, flushed to disk, and removes PATH.partial. At least one frame must have been
  /// added. Throws like VideoWriter, and IoError; PATH is then as it was before.
  void finish();

 private:
  class Bytes;

  std::string path_;
  std::unique_ptr<Bytes> partial_;
  std::unique_ptr<render::VideoWriter> writer_;
};

}  // namespace qsmpc::harness
