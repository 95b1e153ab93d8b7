// What the best affine fits of e^{iφ} leave of a unicycle's position, exactly in mean square.
//
// Under a Gaussian heading φ ~ N(m, v) the best affine fit of e^{iφ} is e^{im − v/2}(1 + i(φ − m)).
// The headings of the surrogate are jointly Gaussian, so the residuals' second moments have a
// closed form, correlations included (docs/theory/surrogate.md, section 3).
#pragma once

#include <vector>

#include <Eigen/Core>

#include "controller/measure/measures.hpp"
#include "models/dynamics/dynamics.hpp"

namespace qsmpc {

/// E[ρ_i ρ_jᵀ] of the residuals ρ = (Re r, Im r) of two headings with means m, variances v and
/// covariance c, for a reach of one.
[[nodiscard]] Eigen::Matrix2d residual_moments(double mean_i, double variance_i, double mean_j,
                                               double variance_j, double covariance);

/// The position residuals of all stages so far, carried along: κ_{k+1} = A_k κ_k + reach ρ_k.
class UnicycleResidual {
 public:
  explicit UnicycleResidual(const UnicycleStructure& unicycle, Eigen::Index dim);

  /// Adds the residual of a stage with the surrogate's law `law` and its affine map's `transition`.
  /// Takes O(stages) time.
  void add_stage(const Gaussian& law, const Eigen::MatrixXd& transition);

  /// √E κ_i² of the last stage added, coordinate by coordinate.
  [[nodiscard]] Eigen::VectorXd root_mean_squares() const;

 private:
  struct Past {
    double mean;                 ///< of the heading
    double variance;             ///< of the heading
    Eigen::VectorXd covariance;  ///< Cov(state now, heading then)
    Eigen::MatrixXd carried;     ///< n x 2: the residual of then, as it is now
  };

  UnicycleStructure unicycle_;
  std::vector<Past> past_;
  Eigen::MatrixXd second_moment_;  ///< E[κ κᵀ]
};

}  // namespace qsmpc
