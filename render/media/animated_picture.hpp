// Animated pictures, made from a finished video: their colours depend on all of it.
#pragma once

#include <string>

#include "render/media/byte_file.hpp"
#include "render/media/video_format.hpp"

namespace qsmpc::render {

/// Writes what the video in `source` shows to `target`, `frames_per_second` pictures a second, as a
/// GIF or WebP that is shown again and again. One picture at a time is held in memory. `quality`:
/// 0 … 100. Throws what the files throw, else std::runtime_error "WHAT: the library's words".
struct AnimatedPicture {
  VideoFormat format = VideoFormat::kGif;
  int frames_per_second = 0;
  int quality = kUsualQuality;
};
void write_animated_picture(const AnimatedPicture& wanted, ByteFile& source, ByteFile& target,
                            const std::string& what);

}  // namespace qsmpc::render
