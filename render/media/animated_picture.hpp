// Animated pictures, made from a finished video because their colours depend on all of it.
#pragma once

#include <string>

#include "render/media/byte_file.hpp"
#include "render/media/video_format.hpp"

namespace qsmpc::render {

/// Writes the video in `source` to `target` as a looping GIF or WebP with `frames_per_second`
/// pictures per second. Only one picture at a time is held in memory. `quality`: 0 … 100. Throws
/// what the files throw, otherwise std::runtime_error "WHAT: the library's message".
struct AnimatedPicture {
  VideoFormat format = VideoFormat::kGif;
  int frames_per_second = 0;
  int quality = kUsualQuality;
};
void write_animated_picture(const AnimatedPicture& wanted, ByteFile& source, ByteFile& target,
                            const std::string& what);

}  // namespace qsmpc::render
