// Upper bounds of P(x ∈ U) for x = y + e, where y is a Gaussian mixture and e any error of known
// mean square: bound C2, and the form that C3 takes (docs/theory/certificates.md, section 3).
//
// If y + e is unsafe, then |e| is at least the distance d(y) to the unsafe set, so for every t > 0
//     1{y + e ∈ U} ≤ (1 − d(y)²/t²)₊ + |e|²/t²,
// hence P(x ∈ U) ≤ E(1 − d(y)²/t²)₊ + E|e|²/t². The expectation has a closed form for each face of
// the safe set; U is a union, so the parts are added.
#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "controller/certification/smoothed_kernels.hpp"
#include "controller/measure/measures.hpp"
#include "controller/planning/safe_set.hpp"

namespace qsmpc::controller {

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

/// At least E(1 − d(y, U)²/t²)₊ for y ~ N(mean, covariance) and U the complement of `safe_set`. t >
/// 0.
[[nodiscard]] double soft_unsafe_probability(const Eigen::Ref<const Eigen::VectorXd>& mean,
                                             const Eigen::Ref<const Eigen::MatrixXd>& covariance,
                                             const SafeSet& safe_set, double t);

/// Σ weights_i N(centre_i, covariance); refers to what must outlive it.
struct GaussianMixture {
  const Points& centres;           ///< state_dim x n
  const Eigen::VectorXd& weights;  ///< n
  const Eigen::MatrixXd& covariance;
};

/// An upper bound of P(y + e ∈ U) for y ~ mixture and any e with E|e|² ≤ radius²: the least over a
/// search in t, each of whose values is a bound. 1 as soon as no value below `useful_below` is
/// possible.
[[nodiscard]] double smoothed_probability(const GaussianMixture& mixture, const SafeSet& safe_set,
                                          double radius, double useful_below = 1.0);

}  // namespace qsmpc::controller
