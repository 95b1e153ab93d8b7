// The weights and targets of the quadratic cost.
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
  /// States whose target is meant modulo 2π. For each plan, a planner shifts the target to its
  /// equivalent nearest to the belief's mean; HorizonCost takes it as it is.
  std::vector<int> angles{};
  /// For a moving target: r of each stage, state_dim x (horizon + 1). Without columns, r is
  /// `target` at every stage.
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
