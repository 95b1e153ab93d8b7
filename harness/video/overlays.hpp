// Which overlays an episode's pictures have.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#pragma GCC visibility push(default)

namespace qsmpc::harness {

struct Overlays {
  bool particles = true;  ///< every stage's points, area by weight
  bool ellipses = true;   ///< 50 % and 95 % of every stage; forecasts of what moves
  bool tube = true;       ///< along the plan, coloured by the stages' certificates
  bool ghost = true;      ///< the vehicle where the plan before predicted it to be now
  bool raw = false;       ///< the points that were compressed to the particles
  bool body = true;       ///< the outline of the vehicle's discs on the ground
  bool path = true;       ///< the driven path's clearance as its colour
};

/// The overlays with these names, no others. Throws std::invalid_argument on a name that is none.
[[nodiscard]] Overlays overlays_of(const std::vector<std::string>& names);

/// What a list on the command line stands for, e.g. "tube,ghost"; "all" and "none" stand alone.
/// Throws InputError, whose key is `option`, on anything else.
[[nodiscard]] Overlays parse_overlays(std::string_view text, std::string_view option);

}  // namespace qsmpc::harness

#pragma GCC visibility pop
