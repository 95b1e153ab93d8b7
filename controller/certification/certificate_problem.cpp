#include "controller/certification/certificate_problem.hpp"

namespace qsmpc::controller {
CertificateProblem::CertificateProblem(const PredictedMotion& motion, const UnsafeSet& unsafe,
                                       const std::vector<StageBudget>& budgets,
                                       CertificateEffort effort, const Executor& run)
    : motion_(motion),
      unsafe_(unsafe),
      budgets_(budgets),
      effort_(effort),
      run_(run),
      clearances_(motion.policy.horizon()) {
  const auto stage = [&](int k) {
    clearances_[k] = clearances(motion.prediction.stages[k + 1].locations, unsafe, k + 1);
  };
  run(static_cast<int>(clearances_.size()), stage);
}

const SurrogateBounds& CertificateProblem::surrogate_bounds() const {
  if (!surrogate_bounds_) {
    surrogate_bounds_ = controller::surrogate_bounds(motion_, unsafe_, effort_, run_);
  }
  return *surrogate_bounds_;
}

}  // namespace qsmpc::controller
