// The contents of a video file, found by decoding all of it.
#pragma once

#include <string>

#include "render/frame.hpp"

namespace qsmpc::render {

struct DecodedVideo {
  std::string codec;
  int width = 0;
  int height = 0;
  int frames = 0;
  double duration = 0.0;  ///< s, as the container says
  bool bt709 = false;
  Image first;  ///< the first frame
};

/// Throws std::runtime_error when the file cannot be decoded to its end.
[[nodiscard]] DecodedVideo decode_video(const std::string& path);

}  // namespace qsmpc::render
