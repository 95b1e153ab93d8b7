// The penalties of planning (penalty.hpp, expected_bounds.hpp), particle by particle in scalar
// code.
#pragma once

#include <Eigen/Core>

#include "controller/planning/cost/penalty.hpp"
#include "controller/regions/safe_set.hpp"
#include "tests/support/point_penalty.hpp"

namespace qsmpc::testing {

/// Keeps references to both arguments.
class PlainPenalty {
 public:
  PlainPenalty(const controller::SafeSet& safe_set, const controller::Penalty& penalty)
      : safe_set_(safe_set), penalty_(penalty) {}

  /// Penalty of one particle, without its weight; adds the gradient to `slope`.
  PenaltyValue operator()(const Eigen::VectorXd& x, Eigen::VectorXd& slope) const;

  /// Penalty of the bounds, for particles (d x n) that stand for normal laws with these deviations;
  /// 0 for the thesis's penalty, whose operator() includes the bounds. Overwrites `slopes` (d x n)
  /// and `deviation_slopes` (d) with the derivatives of the weighted sum by the particles and by
  /// the deviations.
  double of_bounds(const Eigen::MatrixXd& x, const Eigen::VectorXd& weights,
                   const Eigen::VectorXd& deviations, Eigen::MatrixXd& slopes,
                   Eigen::VectorXd& deviation_slopes) const;

 private:
  [[nodiscard]] PenaltyValue smooth(const Eigen::VectorXd& x, Eigen::VectorXd& slope) const;
  [[nodiscard]] PenaltyValue thesis(const Eigen::VectorXd& x, Eigen::VectorXd& slope) const;

  const controller::SafeSet& safe_set_;
  const controller::Penalty& penalty_;
};

}  // namespace qsmpc::testing
