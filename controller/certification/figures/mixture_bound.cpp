#include <algorithm>

#include "controller/certification/certificate_problem.hpp"
#include "controller/certification/figures/figures.hpp"
#include "controller/certification/smoothed_bound.hpp"

namespace qsmpc::controller {

StageFigure mixture_bound(const CertificateProblem& problem) {
  return [&problem](std::size_t k, double least) {
    const PredictedMotion& motion = problem.motion();
    const StageBudget& budget = problem.budgets()[k + 1];
    const GaussianMixture stepped{.centres = motion.prediction.stepped[k],
                                  .weights = motion.prediction.stages[k].weights,
                                  .covariance = motion.noise_covariance};
    const bool every = problem.effort() != CertificateEffort::kLeast;
    const double useful = every ? 1.0 : least - budget.leaving;
    return std::min(
        1.0, budget.leaving + smoothed_probability(stepped, problem.unsafe(), budget.before_noise,
                                                   useful, static_cast<Eigen::Index>(k) + 1));
  };
}

}  // namespace qsmpc::controller
