// A small convex quadratic programme with box constraints, solved by projected Newton steps.
//
//   minimise  gᵀd + ½ dᵀBd   subject to  lower ≤ d ≤ upper,  lower ≤ 0 ≤ upper.
//
// As Bertsekas (1982, Projected Newton Methods for Optimization Problems with Simple Constraints):
// entries at a bound whose slope points outwards are held, the others take the Newton step of their
// block of the Hessian, and the step is projected.
#pragma once

#include <vector>

#include <Eigen/Core>

namespace qsmpc::controller {

class BoxQp {
 public:
  /// Scratch for n entries; allocates only if n has changed.
  void resize(Eigen::Index n);

  /// `hessian` (n x n) is symmetric; bounds may be infinite. Returns false if it is not positive
  /// definite on the free entries; then `step` is not usable. Otherwise `step` has a value below
  /// zero, unless zero is optimal. Allocates nothing.
  [[nodiscard]] bool solve(const Eigen::MatrixXd& hessian, const Eigen::VectorXd& gradient,
                           const Eigen::VectorXd& lower, const Eigen::VectorXd& upper,
                           Eigen::VectorXd& step);

  /// gᵀd + ½ dᵀBd of the last step found: the predicted change, negative.
  [[nodiscard]] double value() const { return value_; }

 private:
  [[nodiscard]] bool collect_free(const Eigen::VectorXd& step, const Eigen::VectorXd& lower,
                                  const Eigen::VectorXd& upper);
  [[nodiscard]] bool newton_direction(const Eigen::MatrixXd& hessian);
  [[nodiscard]] bool advance(const Eigen::MatrixXd& hessian, const Eigen::VectorXd& gradient,
                             const Eigen::VectorXd& lower, const Eigen::VectorXd& upper,
                             Eigen::VectorXd& step);

  std::vector<Eigen::Index> free_;
  Eigen::VectorXd factor_;     // Cholesky factor of the free block, column-major
  Eigen::VectorXd direction_;  // of the free entries
  Eigen::VectorXd trial_;
  Eigen::VectorXd curved_;  // Bd of the trial
  Eigen::VectorXd slope_;   // g + Bd
  double value_ = 0.0;
  bool clipped_ = false;  // the last step met a bound, or was shortened
};

}  // namespace qsmpc::controller
