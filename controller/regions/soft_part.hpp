// E(1 − d(y, box)²/t²)₊ of Gaussians y, of which bounds C2 and C3 are made
// (docs/theory/certificates.md, section 3): closed forms for an interval, products or the least of
// them for a box.
#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "controller/regions/safe_set.hpp"
#include "controller/regions/soft_kernels.hpp"

namespace qsmpc::controller {

/// Beyond this many standard deviations a normal tail is below 1e-17; it counts as kTailAllowance.
inline constexpr double kTail = 8.6;
inline constexpr double kTailAllowance = 1e-17;

/// E(1 − dist(y, [lower, upper])²/t²)₊ for y ~ N(mean, deviation²): at least the value up to
/// rounding, which is added. lower ≤ upper, either may be infinite; deviation ≥ 0; t > 0.
[[nodiscard]] double soft_interval_probability(double mean, double deviation, double lower,
                                               double upper, double t);

/// A box as a Gaussian y sees it: intervals, each for another projection of y less its mean. Where
/// y's coordinates are independent their values are multiplied, else each alone is a bound.
struct SoftPart {
  std::vector<SoftInterval> intervals;
  bool independent = true;
};

/// What does not depend on t of the bounds for y ~ N(mean, covariance) and `box`; a face of the
/// bounds is a box with one finite end.
[[nodiscard]] SoftPart soft_part(const Eigen::Ref<const Eigen::VectorXd>& mean,
                                 const Eigen::Ref<const Eigen::MatrixXd>& covariance,
                                 const Box& box);

/// At least E(1 − d(y, box)²/t²)₊. t > 0.
[[nodiscard]] double soft_part_probability(const SoftPart& part, double t);

/// The same without what does not depend on t having been prepared.
[[nodiscard]] double soft_part_probability(const Eigen::Ref<const Eigen::VectorXd>& mean,
                                           const Eigen::Ref<const Eigen::MatrixXd>& covariance,
                                           const Box& box, double t);

/// The same for every t of `reaches`, which has room for kSoftReaches, into `out`; greater by what
/// the vector loops allow for.
inline constexpr std::size_t kSoftReaches = 8;
void soft_part_by_reach(const SoftPart& part, const double* reaches, double* out);

/// The t that serves where there is no error at all: the bound tends to P(y ∈ U) as t → 0.
inline constexpr double kSmallestReach = 1e-4;

/// Whether `covariance` is diagonal in the coordinates in which `box` is bounded.
[[nodiscard]] bool diagonal_on(const Eigen::Ref<const Eigen::MatrixXd>& covariance, const Box& box);

}  // namespace qsmpc::controller
