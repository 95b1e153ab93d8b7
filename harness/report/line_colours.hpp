// The driven line of a map in classes of a quantity: how fast it was driven, how risky it was.
#pragma once

#include <string>
#include <vector>

#include "harness/figures/plane_map.hpp"
#include "harness/trace/trace.hpp"

namespace qsmpc::harness {

/// Which class each period of a drive is in.
struct LineColours {
  std::string title;
  std::string note{};
  std::vector<std::string> names;  ///< of the kScaleSize classes, from little to much
  std::vector<int> classes;        ///< by period; −1 where nothing is known
};

/// Classes of equal width from the slowest to the fastest period: of the way between two control
/// instants, in the plane of position, which the system must have.
[[nodiscard]] LineColours speed_colours(const Trace& trace);

/// Classes by decades of the certified probability of being unsafe at the next control instant.
[[nodiscard]] LineColours risk_colours(const Trace& trace);

/// The line through the places at the control instants, one more than there are periods, in runs of
/// one class each. Each class with a run is named once in the legend.
[[nodiscard]] std::vector<MapPath> coloured_line(const LineColours& colours,
                                                 const std::vector<MapPoint>& places);

}  // namespace qsmpc::harness
