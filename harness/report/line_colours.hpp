// Colour classes of a map's driven line by a quantity: speed or risk.
#pragma once

#include <string>
#include <vector>

#include "harness/figures/plane_map.hpp"
#include "harness/trace/trace.hpp"

namespace qsmpc::harness {

/// The class of each period of a drive.
struct LineColours {
  std::string title;
  std::string note{};
  std::vector<std::string> names;  ///< of the kScaleSize classes, from low to high
  std::vector<int> classes;        ///< by period; −1 if unknown
};

/// Classes of equal width from the slowest to the fastest period. The speed is that between two
/// control instants in the plane of position, which the system must have.
[[nodiscard]] LineColours speed_colours(const Trace& trace);

/// Classes by decades of the certified probability of being unsafe at the next control instant.
[[nodiscard]] LineColours risk_colours(const Trace& trace);

/// The line through `places`, those at the control instants (one more than periods), split into
/// runs of one class each. Each class with a run appears once in the legend.
[[nodiscard]] std::vector<MapPath> coloured_line(const LineColours& colours,
                                                 const std::vector<MapPoint>& places);

}  // namespace qsmpc::harness
