#include "controller/certification/certificate_problem.hpp"

#include <numeric>

#include "controller/certification/first_entry.hpp"

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

const ConditionedBounds& CertificateProblem::conditioned_bounds() const {
  if (!conditioned_bounds_) {
    conditioned_bounds_ =
        controller::conditioned_bounds(motion_, unsafe_, surrogate_bounds(), effort_, run_);
  }
  return *conditioned_bounds_;
}

const std::vector<double>& CertificateProblem::first_entries() const {
  if (!first_entries_) {
    first_entries_ = first_entry_bounds(unsafe_, surrogate_bounds());
    const auto sum = [](const std::vector<double>& entries) {
      return std::accumulate(entries.begin(), entries.end(), 0.0);
    };
    if (effort_ != CertificateEffort::kLeast) {
      const std::vector<double>& conditioned = conditioned_bounds().entries;
      if (!conditioned.empty() && sum(conditioned) < sum(*first_entries_)) {
        first_entries_ = conditioned;
      }
    }
  }
  return *first_entries_;
}

}  // namespace qsmpc::controller
