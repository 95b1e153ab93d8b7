// The weights of the quadratic cost, and what it is about.
#pragma once

#include <vector>

#include <Eigen/Core>

#pragma GCC visibility push(default)

namespace qsmpc::controller {

/// Weights of Eq. 4-18 and 4-19 about a target state r.
struct QuadraticCost {
  Eigen::MatrixXd state;     ///< Q, state_dim x state_dim
  Eigen::MatrixXd input;     ///< R, input_dim x input_dim
  Eigen::MatrixXd terminal;  ///< Q_term, state_dim x state_dim
  Eigen::VectorXd target;    ///< r, state_dim
  /// States whose target is meant modulo 2π. A planner shifts the target, for each plan, to what is
  /// nearest to the belief's mean; HorizonCost takes it as it is.
  std::vector<int> angles{};
  /// Where the target moves: r of each stage, state_dim x (horizon + 1). Without a column it is
  /// `target` at all of them.
  Eigen::MatrixXd stage_targets{};

  /// r of a stage, 0 … horizon; refers to this.
  [[nodiscard]] Eigen::Map<const Eigen::VectorXd> target_at(Eigen::Index stage) const {
    const double* const data =
        stage_targets.cols() > 0 ? stage_targets.col(stage).data() : target.data();
    return {data, target.size()};
  }
};

}  // namespace qsmpc::controller

#pragma GCC visibility pop
