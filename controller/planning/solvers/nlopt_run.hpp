// The only interface to NLopt: a run of one of its methods on our callbacks.
#pragma once

#include <functional>
#include <optional>

#include <Eigen/Core>

namespace qsmpc::controller {

enum class NloptMethod { kLbfgs, kSlsqp };

enum class NloptEnd {
  kConverged,
  kStopped,  ///< a callback requested it
  kStalled,  ///< NLopt gave up, because of rounding or otherwise
};

struct NloptRun {
  NloptMethod method = NloptMethod::kLbfgs;
  /// Value at x; overwrites the gradient, of the same size. An empty result stops the run.
  std::function<std::optional<double>(const Eigen::VectorXd& x, Eigen::VectorXd& gradient)> cost{};
  double relative_tolerance = 1e-6;  ///< of the cost
  Eigen::VectorXd lower{};           ///< empty: none
  Eigen::VectorXd upper{};           ///< empty: none
  Eigen::Index constraint_count = 0;
  double constraint_tolerance = 0.0;
  /// Values (constraint_count) and gradients (n x constraint_count) of c(x) ≤ 0. False stops the
  /// run.
  std::function<bool(const Eigen::VectorXd& x, Eigen::VectorXd& values, Eigen::MatrixXd& gradients)>
      constraints{};
};

/// Runs from `start`. Exceptions of the callbacks pass through. NLopt may ask again for the cost at
/// an earlier point, and once more after a stop; it has no evaluation limit and runs for as long as
/// the cost answers.
NloptEnd run_nlopt(const NloptRun& run, const Eigen::VectorXd& start);

}  // namespace qsmpc::controller
