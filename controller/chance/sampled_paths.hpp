// Paths of the model under one policy, each with its own start and noise, which are held while
// inputs are searched for: what sample averages, and constraints on samples, are made of.
//
//     x_{k+1} = f(x_k, u_k) + w_k,   u_k = sat(v_k + K_k (x_k − x̄_k) + Σ_l M_kl w_{k−l})
//
// with x̄ the noise-free path from the belief's mean, which goes along as a path of its own.
#pragma once

#include <algorithm>
#include <vector>

#include <Eigen/Core>

#include "controller/measure/measures.hpp"
#include "controller/planning/cost/cost_parts.hpp"
#include "controller/planning/cost/quadratic_cost.hpp"
#include "controller/prediction/policy.hpp"
#include "models/dynamics/dynamics.hpp"

namespace qsmpc::controller {

/// Starts and noises of some paths.
struct PathDraw {
  Points start;               ///< state_dim x paths; no column: the noise-free path alone
  std::vector<Points> noise;  ///< horizon of state_dim x paths
};

class SampledPaths {
 public:
  /// Refers to the dynamics. memory: how many of the noises before a stage its input may answer to,
  /// by matrices M that belong to the decision; 0: none. Only with paths of their own.
  SampledPaths(const models::Dynamics& dynamics, const InputBounds& bounds, Eigen::Index horizon,
               Eigen::Index memory);

  [[nodiscard]] Eigen::Index horizon() const { return horizon_; }
  /// Entries of a decision z: the inputs v stage by stage, and then the matrices M, stage by stage
  /// and from the last noise backwards, each column by column.
  [[nodiscard]] Eigen::Index decisions() const { return decisions_; }
  /// The entries of `z` that are inputs.
  [[nodiscard]] Eigen::Index inputs_in_decision() const { return horizon_ * input_dim_; }
  /// The decision a stage later: what belonged to a stage belongs to the one before it.
  void shift(Eigen::VectorXd& z) const;

  /// From now on: these starts and noises, about the noise-free path from `mean` (state_dim). The
  /// draw must stay alive and unchanged.
  void hold(const Eigen::VectorXd& mean, const PathDraw& draw);
  /// From now on: these gains K (horizon of input_dim x state_dim); none if empty. Must stay alive.
  void hold_gains(const std::vector<Eigen::MatrixXd>& gains);

  /// Moves all paths to where `z` puts them, unless they are there.
  void rollout(const Eigen::VectorXd& z);

  /// States at stage 0 … horizon, state_dim x (paths + 1): the last is the noise-free one.
  [[nodiscard]] const Points& states(Eigen::Index stage) const { return stages_[stage].states; }
  /// How many paths there are beside the noise-free one.
  [[nodiscard]] Eigen::Index paths() const { return paths_; }
  /// How many columns of `states`, the first, stand for the law: the paths or, without any, the
  /// noise-free one.
  [[nodiscard]] Eigen::Index counted() const { return paths_ > 0 ? paths_ : 1; }

  /// The mean cost of the counted paths as they are, with the weights ½ Q, R and P; what it depends
  /// on is added to the adjoints.
  CostParts add_cost(const QuadraticCost& cost);
  /// Adjoints of the states at stage 1 … horizon, as `states`, to add to; `clear_adjoints` first.
  [[nodiscard]] Points& adjoint(Eigen::Index stage) { return stages_[stage].adjoint; }
  void clear_adjoints();
  /// Adds to `gradient` (decisions) what the adjoints are as a derivative by the decision. Where an
  /// input saturates, the derivative of the clamp is zero. Overwrites the adjoints.
  void pull_back(Eigen::VectorXd& gradient);

 private:
  struct Stage {
    Points states;
    Points adjoint;        // of the states
    Points inputs;         // applied; input_dim x (paths + 1)
    Points input_adjoint;  // of the inputs that are applied
    Points pulled;         // of the states, through f alone
  };

  [[nodiscard]] Eigen::Index lags(Eigen::Index stage) const { return std::min(stage, memory_); }
  void apply_policy(Eigen::Index stage, const Eigen::VectorXd& z);
  void resize();

  const models::Dynamics& dynamics_;
  InputBounds bounds_;
  Eigen::Index horizon_;
  Eigen::Index memory_;
  Eigen::Index state_dim_;
  Eigen::Index input_dim_;
  Eigen::Index decisions_ = 0;
  std::vector<Eigen::Index> first_matrix_;  // where a stage's matrices begin in a decision
  const PathDraw* draw_ = nullptr;
  const std::vector<Eigen::MatrixXd>* gains_ = nullptr;
  Eigen::VectorXd mean_;
  Eigen::Index paths_ = 0;
  std::vector<Stage> stages_;
  Eigen::VectorXd rolled_out_;  // the decision that the states belong to, …
  bool is_rolled_out_ = false;  // … if any
  Points away_;                 // scratch: state_dim x paths
  Points weighted_;
  Points through_input_;  // input_dim x (paths + 1)
  Eigen::VectorXd input_sum_;
};

}  // namespace qsmpc::controller
