// Beliefs as particles. In a control loop the mean of the belief changes and the covariance seldom
// does, so the points of one covariance are cached and translated.
#pragma once

#include <Eigen/Core>

#include "controller/measure/measures.hpp"
#include "controller/measure/quantisation/gaussian_quantiser.hpp"

#pragma GCC visibility push(default)

namespace qsmpc::controller {

class BeliefQuantiser {
 public:
  /// For beliefs of dimension `dim`; budget: largest number of points.
  BeliefQuantiser(Eigen::Index dim, int budget, QuantiserKind kind)
      : dim_(dim), budget_(budget), kind_(kind) {}

  /// Writes the quantisation of `belief` to `out`, whose storage is reused. Allocates only when the
  /// covariance has changed. Throws std::invalid_argument on a belief of another dimension or with
  /// non-finite entries, and as `quantise` does.
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
