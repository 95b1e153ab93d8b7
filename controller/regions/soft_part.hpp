// E(1 − d(y, box)²/t²)₊ for Gaussian y, the building block of bounds C2 and C3
// (docs/theory/certificates.md, section 3): closed forms for an interval; for a box, the product or
// the least of these.
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

/// An upper bound of E(1 − dist(y, [lower, upper])²/t²)₊ for y ~ N(mean, deviation²): the value
/// plus an allowance for rounding. lower ≤ upper, either may be infinite; deviation ≥ 0; t > 0.
[[nodiscard]] double soft_interval_probability(double mean, double deviation, double lower,
                                               double upper, double t);

/// A box as seen by a Gaussian y: one interval for each of several projections of y less its mean.
/// If y's coordinates are independent, the intervals' values are multiplied; otherwise each value
/// is a bound by itself.
struct SoftPart {
  std::vector<SoftInterval> intervals;
  bool independent = true;
};

/// The part of the bounds for y ~ N(mean, covariance) and `box` that does not depend on t; a face
/// of the bounds is a box with one finite end.
[[nodiscard]] SoftPart soft_part(const Eigen::Ref<const Eigen::VectorXd>& mean,
                                 const Eigen::Ref<const Eigen::MatrixXd>& covariance,
                                 const Box& box);

/// An upper bound of E(1 − d(y, box)²/t²)₊. t > 0.
[[nodiscard]] double soft_part_probability(const SoftPart& part, double t);

/// The same without a prepared SoftPart.
[[nodiscard]] double soft_part_probability(const Eigen::Ref<const Eigen::VectorXd>& mean,
                                           const Eigen::Ref<const Eigen::MatrixXd>& covariance,
                                           const Box& box, double t);

/// Writes the same for each of the kSoftReaches values t of `reaches` to `out`; larger by the
/// allowances of the vector loops.
inline constexpr std::size_t kSoftReaches = 8;
void soft_part_by_reach(const SoftPart& part, const double* reaches, double* out);

/// The t used if there is no error: the bound tends to P(y ∈ U) as t → 0.
inline constexpr double kSmallestReach = 1e-4;

/// Whether `covariance` is diagonal in the coordinates in which `box` is bounded.
[[nodiscard]] bool diagonal_on(const Eigen::Ref<const Eigen::MatrixXd>& covariance, const Box& box);

}  // namespace qsmpc::controller
