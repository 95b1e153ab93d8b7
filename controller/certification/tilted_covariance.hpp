// The covariance of a surrogate from stage to stage under a tilted law of the path's noise.
#pragma once

#include <Eigen/Core>

#include "controller/certification/path_tilt.hpp"
#include "controller/measure/measures.hpp"

namespace qsmpc::controller {

/// With S_k = Cov z_k and s_k = Cov(z_k, a) under the untilted law, the tilted covariance is
/// S − s diag(1 − w²) sᵀ, and the noise of block j has the mean Γ_j c. Without a tilt the
/// covariance is S, and nothing else is done.
class TiltedCovariance {
 public:
  /// Refers to the tilt.
  explicit TiltedCovariance(const PathTilt& tilt);

  /// law: that of the belief; replaced by its tilted law.
  void start(Gaussian& law);
  /// law: on entry, its mean is that of A z + b; replaced by the law of A z + b + w_stage.
  void step(Eigen::Index stage, const Eigen::MatrixXd& transition,
            const Eigen::MatrixXd& noise_covariance, Gaussian& law);

  [[nodiscard]] bool is_tilted() const { return !tilt_.empty(); }
  /// Tilted covariance of z with z of the previous stage; empty before the first step.
  [[nodiscard]] const Eigen::MatrixXd& with_last() const { return with_last_; }
  /// S
  [[nodiscard]] const Eigen::MatrixXd& covariance() const { return covariance_; }
  /// Row `axis` of s diag(1 − w²)^½: the tilt reduces a covariance by the inner product of two such
  /// rows.
  [[nodiscard]] Eigen::VectorXd with_functionals(Eigen::Index axis) const {
    return with_.row(axis).transpose().cwiseProduct(shares_.cwiseSqrt());
  }

 private:
  void tilt_law(Eigen::Index block, Gaussian& law) const;

  const PathTilt& tilt_;
  Eigen::VectorXd shares_;      ///< 1 − w²
  Eigen::MatrixXd covariance_;  ///< S, n x n
  Eigen::MatrixXd with_;        ///< s, n x r
  Eigen::MatrixXd with_last_;
};

}  // namespace qsmpc::controller
