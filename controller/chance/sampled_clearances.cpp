#include "controller/chance/sampled_clearances.hpp"

#include <cmath>
#include <optional>
#include <utility>

#include "models/constants.hpp"

namespace qsmpc::controller {

const Eigen::ArrayXd& SampledClearances::look(Eigen::Index stage, const SampledPaths& paths) {
  Eigen::ArrayXd& least = stages_[stage - 1];
  states_ = paths.states(stage).leftCols(paths.paths());
  least.setConstant(states_.cols(), kInfinity);
  std::optional<double> bearing;  // that the present sines are for
  for (const DiscView& disc : unsafe_.discs()) {
    const DiscPlacement& placement = disc.placement;
    if (placement.at_position()) {
      for (const RegionPointer& region : disc.regions) {
        region->lower_to_distances(stage, states_, least);
      }
      continue;
    }
    // Discs with the same bearing share their sines, the most expensive part.
    if (bearing != placement.bearing()) turn(placement);
    bearing = placement.bearing();
    centres_ = states_;
    centres_.row(placement.x()).array() += placement.reach() * cosines_.transpose();
    centres_.row(placement.y()).array() += placement.reach() * sines_.transpose();
    for (const RegionPointer& region : disc.regions) {
      region->lower_to_distances(stage, centres_, least);
    }
  }
  least = least.min(1e9);
  return least;
}

/// Cosines and sines of heading + bearing, for the discs with this bearing.
void SampledClearances::turn(const DiscPlacement& placement) {
  cosines_.resize(states_.cols());
  sines_.resize(states_.cols());
  for (Eigen::Index i = 0; i < states_.cols(); ++i) {
    const double angle = states_(placement.heading(), i) + placement.bearing();
    cosines_[i] = std::cos(angle);
    sines_[i] = std::sin(angle);
  }
}

/// The derivative of a path's clearance by its state.
Points::ConstColXpr SampledClearances::slope(Eigen::Index stage, const SampledPaths& paths,
                                             Eigen::Index path) {
  one_ = paths.states(stage).col(path);
  clearances_with_slopes(one_, unsafe_, stage, scratch_, nearest_);
  return std::as_const(nearest_.slope).col(0);
}

}  // namespace qsmpc::controller
