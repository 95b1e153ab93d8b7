// Changes of variables that let an unconstrained solver keep a box: z = z(θ), θ free.
//
// With two finite bounds, z follows a sigmoid between them; with one, a softplus from it; with
// none, z = θ. The penalty keeps z = θ everywhere and penalises the excess.
#pragma once

#include <Eigen/Core>

namespace qsmpc::controller {

enum class InputBounding {
  kSigmoid,  ///< z = lower + (upper − lower) / (1 + e^−θ): Eq. 5-3, for any bounds
  kTanh,     ///< z = middle + half the range · tanh θ
  kPenalty,  ///< z = θ, with a penalty quadratic in the excess
};

class BoundedInputs {
 public:
  /// Bounds of n entries, lower ≤ upper; entries may be infinite. An entry with lower = upper is
  /// fixed.
  BoundedInputs(InputBounding bounding, const Eigen::VectorXd& lower, const Eigen::VectorXd& upper);

  /// z(θ). Within the bounds even after rounding, except for the penalty.
  void inputs(const Eigen::Ref<const Eigen::VectorXd>& theta, Eigen::VectorXd& z) const;
  /// θ with z(θ) = z, for z within the bounds; a z next to a bound is moved in, so that the slope
  /// does not vanish.
  [[nodiscard]] Eigen::VectorXd theta(const Eigen::VectorXd& z) const;
  /// dz/dθ at θ times `gradient`, in place.
  void pull_back(const Eigen::Ref<const Eigen::VectorXd>& theta,
                 Eigen::Ref<Eigen::VectorXd> gradient) const;

  /// Σ (excess / range)², the range being 1 where it is infinite or zero; adds `weight` times its
  /// gradient. Zero within the bounds, hence always zero except for the penalty.
  [[nodiscard]] double excess(const Eigen::VectorXd& z, double weight,
                              Eigen::Ref<Eigen::VectorXd> gradient) const;

 private:
  InputBounding bounding_;
  Eigen::VectorXd lower_;
  Eigen::VectorXd upper_;
};

}  // namespace qsmpc::controller
