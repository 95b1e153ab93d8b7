// Anti-aliasing as a filter of the finished picture: takes a fraction of the time of four samples
// per pixel.
#pragma once

#include <cstdint>
#include <vector>

#include "render/frame.hpp"

namespace qsmpc::render {

/// Scratch of `smooth_edges`; kept between pictures, it makes later ones allocation-free.
struct SmoothingWorkspace {
  std::vector<unsigned char> luma;
  std::vector<unsigned char> edges;     ///< of one row: 1 if the pixel is on an edge, otherwise 0
  std::vector<std::uint32_t> original;  ///< red in the lowest byte, then green and blue
};

/// Blends edge pixels along their edges (T. Lottes, "FXAA", 2009, its shorter variant).
void smooth_edges(Image& image, SmoothingWorkspace& workspace);

}  // namespace qsmpc::render
