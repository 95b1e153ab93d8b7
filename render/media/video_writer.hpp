// Videos, written so that all frames so far are playable even if the process is killed.
//
//   qsmpc::render::VideoWriter video(
//       partial, {.width = 1280, .height = 720, .frames_per_second = 30});
//   for (…) {
//     renderer.draw(frame, image);
//     video.add(image);
//   }
//   video.finish(finished);
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
  /// 59 … 4; GIF: 31 … 255 colours, 255 from 60 on; WebP: libwebp's quality 37 … 100.
  int quality = kUsualQuality;
  std::string preset = "veryfast";  ///< MP4 only: x264's trade-off between time and size
  /// Encoder threads. The pictures do not depend on their number; the bytes of this x264 differ
  /// from run to run.
  int threads = 2;
  std::string name{};  ///< name of the video in messages, e.g. its path
};

/// Writes fragments of one second each to one file, which is playable at any time, and turns it
/// into another file at the end. The first file of a GIF or WebP is a lossless MP4.
class VideoWriter {
 public:
  /// Clears `partial`, writes to it and requires it to outlive this object. Throws
  /// std::invalid_argument if width or height is odd (4:2:0 halves them) or a number is not
  /// positive or out of range; std::runtime_error if there is no such encoder; and what `partial`
  /// throws.
  VideoWriter(ByteFile& partial, const VideoSettings& settings);

  /// `partial` keeps the frames added.
  ~VideoWriter();
  VideoWriter(const VideoWriter&) = delete;
  VideoWriter& operator=(const VideoWriter&) = delete;

  /// Adds the next frame. Throws std::invalid_argument if its size differs, std::runtime_error if
  /// it cannot be encoded, and what `partial` throws if it cannot be written.
  void add(const Image& image);

  /// Writes the whole video to `finished`; an MP4 or WebM can be played before it is read
  /// completely. At least one frame must have been added. Throws std::runtime_error and what the
  /// files throw.
  void finish(ByteFile& finished);

 private:
  struct Encoder;
  std::unique_ptr<Encoder> encoder_;
};

}  // namespace qsmpc::render
