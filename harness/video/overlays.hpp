// The overlays of an episode's pictures.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#pragma GCC visibility push(default)

namespace qsmpc::harness {

struct Overlays {
  bool particles = true;  ///< every stage's points, with area by weight
  bool ellipses = true;   ///< 50 % and 95 % of every stage; forecasts of moving obstacles
  bool tube = true;       ///< along the plan, coloured by the stages' certificates
  bool ghost = true;      ///< the vehicle where the previous plan predicted it to be now
  bool raw = false;       ///< the points that were compressed to the particles
  bool body = true;       ///< the outline of the vehicle's discs on the ground
  bool path = true;       ///< the driven path, coloured by its clearance
};

/// Only the overlays with these names. Throws std::invalid_argument on an unknown name.
[[nodiscard]] Overlays overlays_of(const std::vector<std::string>& names);

/// Parses a list on the command line, e.g. "tube,ghost"; "all" and "none" must stand alone. Throws
/// InputError with key `option` on anything else.
[[nodiscard]] Overlays parse_overlays(std::string_view text, std::string_view option);

}  // namespace qsmpc::harness

#pragma GCC visibility pop
