// Smooth edges as a filter of the finished picture: a fraction of the time of four samples a pixel.
#pragma once

#include <cstdint>
#include <vector>

#include "render/frame.hpp"

namespace qsmpc::render {

/// Scratch of `smooth_edges`, kept between pictures so that none allocates.
struct SmoothingWorkspace {
  std::vector<unsigned char> luma;
  std::vector<unsigned char> edges;     ///< of one row: 1 where a pixel is on an edge, else 0
  std::vector<std::uint32_t> original;  ///< red in the lowest byte, then green and blue
};

/// Blends pixels along the edges that they lie on (T. Lottes, "FXAA", 2009, its shorter variant).
void smooth_edges(Image& image, SmoothingWorkspace& workspace);

}  // namespace qsmpc::render
