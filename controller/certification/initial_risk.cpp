#include "controller/certification/initial_risk.hpp"

#include <algorithm>
#include <functional>
#include <vector>

#include "controller/certification/disc_surrogate.hpp"
#include "controller/measure/normal/norm_orders.hpp"

namespace qsmpc::controller {
namespace {

// A region's contribution below which its bound is not refined further.
constexpr double kNegligibleAtStart = 1e-9;

}  // namespace

double initial_risk(const Gaussian& belief, const UnsafeSet& unsafe) {
  const Eigen::Index dim = belief.mean.size();
  const SurrogateStage start{.law = belief,
                             .with_last = {},
                             .transition = {},
                             .error = Eigen::VectorXd::Zero(dim),
                             .higher = constant_norms(dim, 0.0),
                             .largest = Eigen::VectorXd::Zero(dim),
                             .leaving = 0.0,
                             .region = {}};
  RegionProbability sum;
  for (const DiscView& disc : unsafe.discs()) {
    // The turn of a disc away from the position depends only on the heading.
    const std::function<Eigen::MatrixXd(const std::vector<Eigen::Index>&)> smoothing =
        [&](const std::vector<Eigen::Index>& /*axes*/) {
          return disc.placement.at_position()
                     ? belief.covariance
                     : given_heading(belief.covariance, disc.placement.heading());
        };
    const DiscSurrogate centre = disc_surrogate(start, disc.placement);
    const SurrogateLaw state{.law = centre.law,
                             .error = centre.error,
                             .higher = centre.higher,
                             .smoothing = smoothing,
                             .worthwhile = kNegligibleAtStart};
    for (const RegionPointer& region : disc.regions) {
      region->add_probability(0, state, sum);
    }
  }
  return std::min(1.0, sum.smooth);
}

}  // namespace qsmpc::controller
