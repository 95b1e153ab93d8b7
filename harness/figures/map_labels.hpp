// Texts within a map, each placed where it hides least.
#pragma once

#include <string>
#include <vector>

#include "harness/figures/map_canvas.hpp"

namespace qsmpc::harness {

struct PlacedText {
  std::string text;
  MapPoint at{};
  std::vector<MapPoint> outline{};  ///< the text is placed outside of it; empty: beside `at`
};

/// Places each text near its point, or outside of the outline around it, such that it lies within
/// the map and covers no other text and as few of the points `ink` as possible. Points are
/// drawable. Texts are escaped.
[[nodiscard]] std::string texts_svg(const MapCanvas& canvas, const std::vector<PlacedText>& texts,
                                    const std::vector<MapPoint>& ink);

}  // namespace qsmpc::harness
