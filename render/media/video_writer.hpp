// Videos, written so that what was drawn can be played even if the process is killed.
//
//   qsmpc::render::VideoWriter video(partial, {.width = 1280, .height = 720, .frames_per_second =
//   30}); for (…) { renderer.draw(frame, image); video.add(image); } video.finish(finished);
#pragma once

#include <memory>
#include <string>

#include "render/frame.hpp"
#include "render/media/byte_file.hpp"
#include "render/media/video_format.hpp"

namespace qsmpc::render {

struct VideoSettings {
  VideoFormat format = VideoFormat::kMp4;
  int width = 0;              ///< pixels, even
  int height = 0;             ///< pixels, even
  int frames_per_second = 0;  ///< at most most_frames_per_second(format)
  /// 0 (smallest file) … 100 (best picture). MP4: x264's rate factor 48 … 1; WebM: VP9's quantiser
  /// 59 … 4; GIF: 31 … 255 colours, all of them from 60 on; WebP: libwebp's quality 37 … 100.
  int quality = kUsualQuality;
  std::string preset = "veryfast";  ///< of MP4: x264's trade of time against size
  /// Encoder threads. The pictures do not depend on them; this x264's bytes differ from run to run.
  int threads = 2;
  std::string name{};  ///< what messages call the video, e.g. its path
};

/// Writes pieces of a second each to one file, which can be played at any time, and turns it into
/// another file at the end. The first file of a GIF or WebP is a lossless MP4.
class VideoWriter {
 public:
  /// Clears `partial` and writes to it as long as it lives. Throws std::invalid_argument when width
  /// or height is odd (4:2:0 halves them), a number is not positive or not within its range;
  /// std::runtime_error when there is no such encoder; what `partial` throws.
  VideoWriter(ByteFile& partial, const VideoSettings& settings);

  /// `partial` keeps what was added.
  ~VideoWriter();
  VideoWriter(const VideoWriter&) = delete;
  VideoWriter& operator=(const VideoWriter&) = delete;

  /// Adds the next frame. Throws std::invalid_argument when its size is another one,
  /// std::runtime_error when it cannot be encoded, what `partial` throws when it cannot be written.
  void add(const Image& image);

  /// Writes the whole video to `finished`; an MP4 or WebM plays before it is wholly read. At least
  /// one frame must have been added. Throws std::runtime_error and what the files throw.
  void finish(ByteFile& finished);

 private:
  struct Encoder;
  std::unique_ptr<Encoder> encoder_;
};

}  // namespace qsmpc::render
