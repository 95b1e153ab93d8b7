// Animated pictures, made from a finished video: their colours depend on all of it.
#pragma once

#include <string>

#include "render/media/video_format.hpp"

namespace qsmpc {

/// Writes what the video at `source` shows, `frames_per_second` pictures a second, as a GIF or WebP
/// that is shown again and again. One picture at a time is held in memory, and the file. `quality`:
/// 0 … 100. Throws std::runtime_error "WHAT: the system's words".
struct AnimatedPicture {
  VideoFormat format = VideoFormat::kGif;
  int frames_per_second = 0;
  int quality = kUsualQuality;
};
void write_animated_picture(const AnimatedPicture& wanted, const std::string& source,
                            const std::string& target, const std::string& what);

}  // namespace qsmpc
