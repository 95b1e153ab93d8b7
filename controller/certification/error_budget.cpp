#include "controller/certification/error_budget.hpp"

#include <algorithm>
#include <cmath>

#include "controller/certification/affine_surrogate.hpp"
#include "models/constants.hpp"
#include "models/dynamics/local_lipschitz.hpp"

namespace qsmpc::controller {
namespace {

/// An error after a map with this Lipschitz constant. A zero error stays zero even where no
/// constant is known (0 · ∞ = 0); NaN counts as infinite.
double carried(double lipschitz, double error) {
  if (error == 0.0) return 0.0;
  const double product = lipschitz * error;
  return std::isnan(product) ? kInfinity : product;
}

/// What a model error adds in W2; 0 if there is none.
double radius_of(const ModelError* error) { return error == nullptr ? 0.0 : error->radius(); }

/// √Σ ρ_i |f(c_i, u(c_i)) − f(c'_i, u(c'_i))|², c' the particles moved into `region`.
double projection_w2(const PredictedMotion& motion, Eigen::Index stage, const Box& region) {
  const DiscreteMeasure& particles = motion.prediction.stages[stage];
  Points inside(particles.dim(), particles.size());
  for (Eigen::Index i = 0; i < particles.size(); ++i) {
    inside.col(i) = particles.locations.col(i).cwiseMax(region.lower).cwiseMin(region.upper);
  }
  if (inside == particles.locations) return 0.0;
  Points inputs(motion.policy.inputs.rows(), particles.size());
  Points stepped(particles.dim(), particles.size());
  policy_inputs(motion.policy, stage, inside, inputs);
  motion.dynamics.step(inside, inputs, stepped);
  const Eigen::VectorXd squares =
      (stepped - motion.prediction.stepped[stage]).colwise().squaredNorm().transpose();
  const double square = particles.weights.dot(squares);
  // Non-finite particles are infinitely far from anything.
  return std::isfinite(square) ? std::sqrt(square) : kInfinity;
}

/// Lipschitz constant of the closed loop at a stage, and the cost of restricting it to a region.
struct StageLipschitz {
  double constant = kInfinity;
  double projection = 0.0;  ///< W2 that particles outside of the region add
  double leaving = 0.0;     ///< P(the state has left the regions up to this stage)
};

StageLipschitz on_region(const PredictedMotion& motion, Eigen::Index stage,
                         const std::vector<SurrogateStage>& surrogates) {
  const Box& region = surrogates[stage].region;
  const double leaving = surrogates[stage + 1].leaving;
  const InputBounds& bounds = motion.policy.bounds;
  Eigen::VectorXd lower(region.lower.size() + bounds.lower.size());
  Eigen::VectorXd upper(lower.size());
  lower << region.lower, bounds.lower;
  upper << region.upper, bounds.upper;
  if (leaving >= 1.0 || !(lower.array() <= upper.array()).all()) return {.leaving = 1.0};
  const double constant = models::local_lipschitz(motion.dynamics.derivative_bounds(lower, upper),
                                                  motion.policy.gains[stage]);
  return {.constant = std::isnan(constant) ? kInfinity : constant,
          .projection = projection_w2(motion, stage, region),
          .leaving = leaving};
}

}  // namespace

std::vector<StageBudget> error_budget(const PredictedMotion& motion) {
  const Eigen::Index horizon = motion.policy.horizon();
  const bool global =
      std::all_of(motion.policy.gains.begin(), motion.policy.gains.end(),
                  [&](const auto& gain) { return std::isfinite(motion.dynamics.lipschitz(gain)); });
  const std::vector<SurrogateStage> surrogates =
      global ? std::vector<SurrogateStage>{} : affine_surrogates(motion);
  std::vector<StageBudget> budgets(horizon + 1);
  budgets[0].belief = motion.belief_w2;
  budgets[0].model = radius_of(motion.belief_error);
  budgets[0].total = motion.belief_w2 + budgets[0].model;
  double unstretched = budgets[0].total;  // the total as it would be with L_k ≤ 1
  for (Eigen::Index k = 0; k < horizon; ++k) {
    StageLipschitz lipschitz =
        global ? StageLipschitz{.constant = motion.dynamics.lipschitz(motion.policy.gains[k])}
               : on_region(motion, k, surrogates);
    // Particles that represent the law exactly need no constant, and so no region.
    if (budgets[k].total == 0.0) {
      lipschitz.projection = 0.0;
      lipschitz.leaving = budgets[k].leaving;
    }
    // Non-finite particles are infinitely far from any law.
    const double compression = motion.prediction.maps[k].compression_w2;
    const bool usable =
        motion.prediction.stages[k + 1].locations.allFinite() && !std::isnan(compression);
    const double lost = usable ? compression : kInfinity;
    const auto stepped = [&](double error) { return carried(lipschitz.constant, error); };
    StageBudget& next = budgets[k + 1];
    budgets[k].lipschitz = lipschitz.constant;
    next.leaving = lipschitz.leaving;
    const double model_w2 = radius_of(motion.error_at(k));
    const double apart = lipschitz.projection + model_w2;
    next.before_noise = stepped(budgets[k].total) + apart;
    next.belief = stepped(budgets[k].belief);
    next.noise = std::hypot(stepped(budgets[k].noise), motion.noise_w2);
    next.compression = stepped(budgets[k].compression) + lipschitz.projection + lost;
    next.model = stepped(budgets[k].model) + model_w2;
    next.total = std::hypot(next.before_noise, motion.noise_w2) + lost;
    const double kept = carried(std::min(1.0, lipschitz.constant), unstretched);
    unstretched = std::hypot(kept + apart, motion.noise_w2) + lost;
    // Infinite errors are attributed to the dynamics, unless the particles are lost anyway.
    next.dynamics = std::isinf(unstretched) ? 0.0 : next.total - unstretched;
  }
  return budgets;
}

}  // namespace qsmpc::controller
