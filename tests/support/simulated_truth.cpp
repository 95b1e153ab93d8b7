#include "tests/support/simulated_truth.hpp"

#include <algorithm>

#include "controller/prediction/policy.hpp"
#include "models/linear_algebra.hpp"

namespace qsmpc::testing {
namespace {

/// Written out once more, so that the truth does not rest on what is tested.
bool inside(const controller::Box& box, const controller::Points& states, Eigen::Index i) {
  for (Eigen::Index axis = 0; axis < states.rows(); ++axis) {
    if (states(axis, i) < box.lower[axis] || states(axis, i) > box.upper[axis]) return false;
  }
  return true;
}

bool unsafe(const controller::SafeSet& safe_set, const controller::Points& states, Eigen::Index i) {
  return !inside(safe_set.bounds, states, i) ||
         std::any_of(safe_set.obstacles.begin(), safe_set.obstacles.end(),
                     [&](const controller::Box& obstacle) { return inside(obstacle, states, i); });
}

/// Draws of N(0, covariance), one a column; the covariance may be singular.
class NormalDraws {
 public:
  explicit NormalDraws(const Eigen::MatrixXd& covariance) {
    const models::SymmetricEigen eigen = models::symmetric_eigen(covariance);
    root_ = eigen.vectors * eigen.values.cwiseMax(0.0).cwiseSqrt().asDiagonal();
  }
  [[nodiscard]] controller::Points operator()(Eigen::Index count, Generator& generator) {
    return root_ *
           controller::Points::NullaryExpr(root_.rows(), count, [&] { return normal_(generator); });
  }

 private:
  Eigen::MatrixXd root_;
  std::normal_distribution<double> normal_;
};

}  // namespace

UnsafeCounts simulate(const controller::PredictedMotion& motion,
                      const controller::SafeSet& safe_set, int paths, Generator& generator,
                      std::vector<controller::Points>* states, const PlantError& error) {
  NormalDraws belief(motion.belief.covariance);
  NormalDraws noise(motion.noise_covariance);
  controller::Points current = belief(paths, generator).colwise() + motion.belief.mean;
  controller::Points drawn = controller::Points::Zero(current.rows(), paths);
  if (error && motion.belief_error != nullptr) {
    current += error({.stage = -1, .stepped = current, .last_noise = drawn});
  }
  controller::Points inputs(motion.policy.inputs.rows(), paths);
  controller::Points next(current.rows(), paths);
  UnsafeCounts counts;
  std::vector<bool> ever(paths, false);
  for (Eigen::Index k = 0; k < motion.policy.horizon(); ++k) {
    controller::policy_inputs(motion.policy, k, current, inputs);
    motion.dynamics.step(current, inputs, next);
    if (error) next += error({.stage = k, .stepped = next, .last_noise = drawn});
    drawn = noise(paths, generator);
    current = next + drawn;
    counts.stages.push_back(0);
    for (int i = 0; i < paths; ++i) {
      if (!unsafe(safe_set, current, i)) continue;
      ++counts.stages.back();
      ever[i] = true;
    }
    if (states != nullptr) states->push_back(current);
  }
  counts.any = static_cast<int>(std::count(ever.begin(), ever.end(), true));
  return counts;
}

}  // namespace qsmpc::testing
