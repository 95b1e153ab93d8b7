// A small convex quadratic programme in a box, solved by projected Newton steps.
//
//   minimise  gᵀd + ½ dᵀBd   subject to  lower ≤ d ≤ upper,  lower ≤ 0 ≤ upper.
//
// As Bertsekas (1982, Projected Newton Methods for Optimization Problems with Simple Constraints):
// entries at a bound with the slope pushing outwards are held, the others take the Newton step of
// the block that is theirs, and the step is projected.
#pragma once

#include <vector>

#include <Eigen/Core>

namespace qsmpc::controller {

class BoxQp {
 public:
  /// Scratch for n entries; allocates only if n has changed.
  void resize(Eigen::Index n);

  /// `hessian` (n x n) is symmetric; bounds may be infinite. False if it is not positive definite
  /// on the free entries; then `step` is of no use. Otherwise `step` gives a value below zero,
  /// unless zero is optimal. Allocates nothing.
  [[nodiscard]] bool solve(const Eigen::MatrixXd& hessian, const Eigen::VectorXd& gradient,
                           const Eigen::VectorXd& lower, const Eigen::VectorXd& upper,
                           Eigen::VectorXd& step);

  /// gᵀd + ½ dᵀBd of the step last found: what it promises, negative.
  [[nodiscard]] double value() const { return value_; }

 private:
  [[nodiscard]] bool collect_free(const Eigen::VectorXd& step, const Eigen::VectorXd& lower,
                                  const Eigen::VectorXd& upper);
  [[nodiscard]] bool newton_direction(const Eigen::MatrixXd& hessian);
  [[nodiscard]] bool advance(const Eigen::MatrixXd& hessian, const Eigen::VectorXd& gradient,
                             const Eigen::VectorXd& lower, const Eigen::VectorXd& upper,
                             Eigen::VectorXd& step);

  std::vector<Eigen::Index> free_;
  Eigen::VectorXd factor_;     // the free block's Cholesky factor, its columns one by one
  Eigen::VectorXd direction_;  // of the free entries
  Eigen::VectorXd trial_;
  Eigen::VectorXd curved_;  // Bd of the trial
  Eigen::VectorXd slope_;   // g + Bd
  double value_ = 0.0;
  bool clipped_ = false;  // the last step met a bound, or was shortened
};

}  // namespace qsmpc::controller
