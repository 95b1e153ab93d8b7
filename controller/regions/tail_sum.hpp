// A smooth substitute for the probability that a Gaussian is in a region, for optimisation: the
// slope of its logarithm is useful both far away and deep inside. Derivation:
// docs/theory/planning.md, "Risk".
#pragma once

#include <span>

#include <Eigen/Core>

#pragma GCC visibility push(default)

namespace qsmpc::controller {

/// Φ(−z), continued below z = 0, where Φ(−z) is flat, by the exponential with the same value and
/// slope. It therefore exceeds 1 deep inside a region, where it is a merit function and not a
/// probability.
[[nodiscard]] double extended_tail(double z);

/// Beyond this many standard deviations a tail is 0 in double precision.
inline constexpr double kNoTail = 39.0;

/// Σ over parts of extended_tail(z), z being the number of standard deviations between the mean and
/// the part's nearest point; negative inside.
class TailSum {
 public:
  /// Resets the sum to zero, for laws of `dim` coordinates. Allocates only if the dimension
  /// changes.
  void clear(Eigen::Index dim);

  /// Adds a part. slope: ∂z/∂mean in the coordinates `axes`; ∂z/∂covariance follows from it, as
  /// −½ z · slope slopeᵀ. weight: the probability that the part is there.
  void add(double z, std::span<const Eigen::Index> axes, std::span<const double> slope,
           double weight = 1.0);

  [[nodiscard]] double value() const { return value_; }
  [[nodiscard]] const Eigen::VectorXd& by_mean() const { return by_mean_; }
  /// Symmetric; the derivative by each entry is taken as if that entry alone changed.
  [[nodiscard]] const Eigen::MatrixXd& by_covariance() const { return by_covariance_; }

 private:
  double value_ = 0.0;
  Eigen::VectorXd by_mean_;
  Eigen::MatrixXd by_covariance_;
};

}  // namespace qsmpc::controller

#pragma GCC visibility pop
