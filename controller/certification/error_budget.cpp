#include "controller/certification/error_budget.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace qsmpc {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// An error after a map with this Lipschitz constant. No error stays none, even where no constant
/// is known (0 · ∞); what is not a number counts as infinite.
double carried(double lipschitz, double error) {
  if (error == 0.0) return 0.0;
  const double product = lipschitz * error;
  return std::isnan(product) ? kInfinity : product;
}

}  // namespace

std::vector<StageBudget> error_budget(const PredictedMotion& motion) {
  const double noise_w2 = motion.noise_w2;
  std::vector<StageBudget> budgets(motion.prediction.stages.size());
  budgets[0].belief = motion.belief_w2;
  budgets[0].total = motion.belief_w2;
  double unstretched = motion.belief_w2;  // the total as it would be with L_k ≤ 1
  for (std::size_t k = 0; k + 1 < budgets.size(); ++k) {
    const double lipschitz = motion.dynamics.lipschitz(motion.policy.gains[k]);
    // Particles that are not finite are infinitely far from any law.
    const double compression = motion.prediction.maps[k].compression_w2;
    const bool usable =
        motion.prediction.stages[k + 1].locations.allFinite() && !std::isnan(compression);
    const double lost = usable ? compression : kInfinity;
    budgets[k].lipschitz = lipschitz;
    budgets[k + 1].belief = carried(lipschitz, budgets[k].belief);
    budgets[k + 1].noise = std::hypot(carried(lipschitz, budgets[k].noise), noise_w2);
    budgets[k + 1].compression = carried(lipschitz, budgets[k].compression) + lost;
    budgets[k + 1].total = std::hypot(carried(lipschitz, budgets[k].total), noise_w2) + lost;
    unstretched = std::hypot(carried(std::min(1.0, lipschitz), unstretched), noise_w2) + lost;
    // Infinite errors are blamed on the dynamics, unless the particles are lost anyway.
    budgets[k + 1].dynamics = std::isinf(unstretched) ? 0.0 : budgets[k + 1].total - unstretched;
  }
  return budgets;
}

}  // namespace qsmpc
