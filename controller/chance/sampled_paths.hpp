// Paths of the model under one policy, each with its own start and noise, which are held fixed
// while the inputs are optimised: the basis of sample averages and of constraints on samples.
//
//     x_{k+1} = f(x_k, u_k) + w_k,   u_k = sat(v_k + K_k (x_k − x̄_k) + Σ_l M_kl w_{k−l})
//
// with x̄ the noise-free path from the belief's mean, which is kept as one further path.
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
  Points start;               ///< state_dim x paths; no column: only the noise-free path
  std::vector<Points> noise;  ///< horizon of state_dim x paths
};

class SampledPaths {
 public:
  /// Keeps a reference to the dynamics. memory: the number of past noises that a stage's input
  /// responds to, through matrices M that are part of the decision; 0: none. Only with sampled
  /// paths.
  SampledPaths(const models::Dynamics& dynamics, const InputBounds& bounds, Eigen::Index horizon,
               Eigen::Index memory);

  [[nodiscard]] Eigen::Index horizon() const { return horizon_; }
  /// Entries of a decision z: the inputs v stage by stage, then the matrices M stage by stage, from
  /// the most recent noise backwards, each column-major.
  [[nodiscard]] Eigen::Index decisions() const { return decisions_; }
  /// How many entries of `z`, the first, are inputs.
  [[nodiscard]] Eigen::Index inputs_in_decision() const { return horizon_ * input_dim_; }
  /// Shifts the decision by one stage: the entries of a stage become those of the stage before it.
  void shift(Eigen::VectorXd& z) const;

  /// Sets the starts and noises, about the noise-free path from `mean` (state_dim). The draw must
  /// stay alive and unchanged.
  void hold(const Eigen::VectorXd& mean, const PathDraw& draw);
  /// Sets the gains K (horizon of input_dim x state_dim); none if empty. They must stay alive.
  void hold_gains(const std::vector<Eigen::MatrixXd>& gains);

  /// Rolls out all paths under `z`, unless they are up to date.
  void rollout(const Eigen::VectorXd& z);

  /// States at stage 0 … horizon, state_dim x (paths + 1): the last is the noise-free one.
  [[nodiscard]] const Points& states(Eigen::Index stage) const { return stages_[stage].states; }
  /// Number of paths, without the noise-free one.
  [[nodiscard]] Eigen::Index paths() const { return paths_; }
  /// How many columns of `states`, the first, represent the law: the paths or, without any, the
  /// noise-free one.
  [[nodiscard]] Eigen::Index counted() const { return paths_ > 0 ? paths_ : 1; }

  /// The mean cost of the counted paths as last rolled out, with the weights ½ Q, R and P; adds its
  /// derivatives to the adjoints.
  CostParts add_cost(const QuadraticCost& cost);
  /// Adjoints of the states at stage 1 … horizon, shaped as `states`, to add to; call
  /// `clear_adjoints` first.
  [[nodiscard]] Points& adjoint(Eigen::Index stage) { return stages_[stage].adjoint; }
  void clear_adjoints();
  /// Backward pass: adds to `gradient` (decisions) the derivative by the decision that the adjoints
  /// amount to. Where an input saturates, the derivative of the clamp is zero. Overwrites the
  /// adjoints.
  void pull_back(Eigen::VectorXd& gradient);

 private:
  struct Stage {
    Points states;
    Points adjoint;        // of the states
    Points inputs;         // applied; input_dim x (paths + 1)
    Points input_adjoint;  // of the applied inputs
    Points pulled;         // of the states, through f only
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
