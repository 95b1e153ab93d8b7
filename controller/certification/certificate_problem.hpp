// The inputs of the bounds of one motion, and the intermediate results that several bounds share.
#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include "controller/certification/certificate.hpp"
#include "controller/certification/conditioned_bounds.hpp"
#include "controller/certification/surrogate_bounds.hpp"

namespace qsmpc::controller {

/// Refers to all of its arguments, which must outlive it.
class CertificateProblem {
 public:
  CertificateProblem(const PredictedMotion& motion, const UnsafeSet& unsafe,
                     const std::vector<StageBudget>& budgets, CertificateEffort effort,
                     const Executor& run);

  [[nodiscard]] const PredictedMotion& motion() const { return motion_; }
  [[nodiscard]] const UnsafeSet& unsafe() const { return unsafe_; }
  /// Stages 0 … horizon.
  [[nodiscard]] const std::vector<StageBudget>& budgets() const { return budgets_; }
  [[nodiscard]] CertificateEffort effort() const { return effort_; }
  [[nodiscard]] const Executor& run() const { return run_; }

  /// Clearances of the particles of stage k + 1 from the unsafe set.
  [[nodiscard]] const Eigen::VectorXd& clearance(std::size_t k) const { return clearances_[k]; }
  /// C3 and C4 of stages 1 … horizon, from one search. Computed in the first call; not thread-safe.
  [[nodiscard]] const SurrogateBounds& surrogate_bounds() const;
  /// C5 of the same stages. Computed in the first call; not thread-safe.
  [[nodiscard]] const ConditionedBounds& conditioned_bounds() const;
  /// What stages 1 … horizon add to the probability of being unsafe at any of them: from C3 and C4
  /// as they are or, with more than CertificateEffort::kLeast, conditioned, whichever has the
  /// lesser sum. Computed in the first call; not thread-safe.
  [[nodiscard]] const std::vector<double>& first_entries() const;

 private:
  const PredictedMotion& motion_;
  const UnsafeSet& unsafe_;
  const std::vector<StageBudget>& budgets_;
  CertificateEffort effort_;
  const Executor& run_;
  std::vector<Eigen::VectorXd> clearances_;
  mutable std::optional<SurrogateBounds> surrogate_bounds_;
  mutable std::optional<ConditionedBounds> conditioned_bounds_;
  mutable std::optional<std::vector<double>> first_entries_;
};

}  // namespace qsmpc::controller
