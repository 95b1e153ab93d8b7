// Texts within a map, each where it hides least.
#pragma once

#include <string>
#include <vector>

#include "harness/figures/map_canvas.hpp"

namespace qsmpc::harness {

struct PlacedText {
  std::string text;
  MapPoint at{};
  std::vector<MapPoint> outline{};  ///< what the text stands outside of; empty: beside `at`
};

/// Each text at a place near its point, or outside of its outline about it, that lies within the
/// map and covers no other text and as few of the points `ink` as possible. Points are drawable.
/// Texts are escaped.
[[nodiscard]] std::string texts_svg(const MapCanvas& canvas, const std::vector<PlacedText>& texts,
                                    const std::vector<MapPoint>& ink);

}  // namespace qsmpc::harness
