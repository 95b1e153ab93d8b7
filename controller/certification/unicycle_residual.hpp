// The residual of a unicycle's position under the best affine fits of e^{iφ}, exactly in mean
// square.
//
// Under a Gaussian heading φ ~ N(m, v) the best affine fit of e^{iφ} is e^{im − v/2}(1 + i(φ − m)).
// The headings of the surrogate are jointly Gaussian, so the residuals' second moments have a
// closed form, correlations included (docs/theory/surrogate.md, section 3).
#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "controller/certification/tilted_covariance.hpp"
#include "controller/measure/measures.hpp"
#include "models/dynamics/dynamics.hpp"

namespace qsmpc::controller {

/// E[ρ_i ρ_jᵀ] of the residuals ρ = (Re r, Im r) of two headings with means m, variances v and
/// covariance c, for a reach of one.
[[nodiscard]] Eigen::Matrix2d residual_moments(double mean_i, double variance_i, double mean_j,
                                               double variance_j, double covariance);

/// Bounds of ‖cos δ − e^{−v/2}‖_p and ‖sin δ − e^{−v/2}δ‖_p for δ ~ N(0, v): the residual of the
/// best affine fit along and across the mean heading.
struct HeadingNorms {
  double along;
  double across;
};

/// p = kHigherOrders[k].
[[nodiscard]] HeadingNorms heading_norms(double variance, std::size_t k);

/// The position residuals of all stages so far, propagated: κ_{k+1} = A_k κ_k + reach ρ_k.
class UnicycleResidual {
 public:
  /// For states of `dim` coordinates and at most `stages` stages.
  UnicycleResidual(const models::UnicycleStructure& unicycle, Eigen::Index dim,
                   Eigen::Index stages);

  /// Adds the residual of a stage with the surrogate's law `law` and its affine map's `transition`.
  /// Takes O(stages) time.
  /// tilted: if given, the recursion of the tilted covariance, which is that of `law`.
  void add_stage(const Gaussian& law, const Eigen::MatrixXd& transition,
                 const TiltedCovariance* tilted = nullptr);

  /// √E κ_i² after the last stage added, coordinate by coordinate.
  [[nodiscard]] Eigen::VectorXd root_mean_squares() const;

 private:
  models::UnicycleStructure unicycle_;
  std::vector<double> means_;           ///< of the heading at every stage
  std::vector<double> variances_;       ///< of the same
  std::vector<Eigen::VectorXd> tilts_;  ///< Cov(heading, functionals of the tilt) at every stage
  /// Three columns per stage: the untilted Cov(current state, heading at that stage), and the map
  /// of that stage's residual to the current state.
  Eigen::MatrixXd past_;
  Eigen::MatrixXd shifted_;        ///< of the same size; scratch of a step
  Eigen::MatrixXd second_moment_;  ///< E[κ κᵀ]
};

}  // namespace qsmpc::controller
