// The one place that knows NLopt: a run of one of its methods on callbacks of ours.
#pragma once

#include <functional>
#include <optional>

#include <Eigen/Core>

namespace qsmpc::controller {

enum class NloptMethod { kLbfgs, kSlsqp };

enum class NloptEnd {
  kConverged,
  kStopped,  ///< a callback asked for it
  kStalled,  ///< NLopt gave up, for rounding or for reasons of its own
};

struct NloptRun {
  NloptMethod method = NloptMethod::kLbfgs;
  /// Value at x; overwrites the gradient, of the same size. Nothing: stop.
  std::function<std::optional<double>(const Eigen::VectorXd& x, Eigen::VectorXd& gradient)> cost{};
  double relative_tolerance = 1e-6;  ///< of the cost
  Eigen::VectorXd lower{};           ///< empty: none
  Eigen::VectorXd upper{};           ///< empty: none
  Eigen::Index constraint_count = 0;
  double constraint_tolerance = 0.0;
  /// Values (constraint_count) and gradients (n x constraint_count) of c(x) ≤ 0. False: stop.
  std::function<bool(const Eigen::VectorXd& x, Eigen::VectorXd& values, Eigen::MatrixXd& gradients)>
      constraints{};
};

/// Runs from `start`. What the callbacks throw passes through. NLopt may ask for the cost at a
/// point where it has asked before, once more after a stop, and for as long as the cost answers.
NloptEnd run_nlopt(const NloptRun& run, const Eigen::VectorXd& start);

}  // namespace qsmpc::controller
