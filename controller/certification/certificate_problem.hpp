// What the bounds of one motion are worked out from, and what several of them need.
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

  /// Of the particles of stage k + 1 from the unsafe set.
  [[nodiscard]] const Eigen::VectorXd& clearance(std::size_t k) const { return clearances_[k]; }
  /// C3 and C4 of stages 1 … horizon, which come from one search. Worked out by the first who asks;
  /// not to be asked side by side.
  [[nodiscard]] const SurrogateBounds& surrogate_bounds() const;
  /// C5 of the same; likewise.
  [[nodiscard]] const ConditionedBounds& conditioned_bounds() const;
  /// What stages 1 … horizon add to the probability of being unsafe at any of them: by C3 and C4 as
  /// they are, or, with every effort, conditioned, whichever is less in all. Likewise.
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
