// What a caller chooses about pictures.
#pragma once

#include <string>

#include "render/frame.hpp"

namespace qsmpc {

struct RenderOptions {
  int width = 1280;              ///< pixels, at least 64
  int height = 720;              ///< pixels, at least 64
  std::string camera = "chase";  ///< "chase", "top" or "fixed"
  /// m wanted from the chase camera to what it looks at; kept between 6.5 and 26 vehicle lengths.
  double chase_distance = 0.0;
  /// What the top and fixed cameras must show; of no area: the world's bounds, obstacles and
  /// target.
  PlanarRectangle region;
};

}  // namespace qsmpc
