// Beliefs as particles. A control loop's beliefs differ in their means and seldom in their
// covariance, so that the points of one covariance are kept and moved.
#pragma once

#include <Eigen/Core>

#include "controller/measure/measures.hpp"
#include "controller/measure/quantisation/gaussian_quantiser.hpp"

#pragma GCC visibility push(default)

namespace qsmpc::controller {

class BeliefQuantiser {
 public:
  /// For beliefs of dimension `dim`; budget: points at most.
  BeliefQuantiser(Eigen::Index dim, int budget, QuantiserKind kind)
      : dim_(dim), budget_(budget), kind_(kind) {}

  /// Writes the quantisation of `belief` to `out`, whose storage is reused. Allocates only where
  /// the covariance is another one than before. Throws std::invalid_argument on a belief that is of
  /// another dimension or not finite, and as `quantise`.
  void quantise(const Gaussian& belief, GaussianQuantisation& out);

 private:
  Eigen::Index dim_;
  int budget_;
  QuantiserKind kind_;
  GaussianQuantisation centred_;  // about zero, for `covariance_`
  Eigen::MatrixXd covariance_;    // empty before the first belief
};

}  // namespace qsmpc::controller

#pragma GCC visibility pop
