// The true cost of a policy, and the best policy that an exhaustive search finds: the planning
// problem of docs/theory/planning.md with expectations over simulated paths instead of particles.
//
//   SampledProblem problem(*car, settings, belief, {.paths = 20000, .seed = 1});
//   double price = problem.evaluate(plan.policy);
//
// The draws are frozen, so two policies meet the same noise, and the price is a piecewise smooth
// function of the nominal inputs with a known gradient, including the part through the gains. It
// shares the system, the regulator's gains and the form of the policy with the planner, but none of
// the quantisation, compression, cost, penalty or solver code.
#pragma once

#include <vector>

#include <Eigen/Core>

#include "controller/planning/planner.hpp"
#include "models/dynamics/dynamics.hpp"

namespace qsmpc::testing {

struct Draws {
  int paths = 2000;
  unsigned seed = 1;
};

class SampledProblem {
 public:
  /// `dynamics` must outlive the problem. Takes every penalty except the thesis's, for which it
  /// throws std::invalid_argument.
  SampledProblem(const models::Dynamics& dynamics, const controller::PlannerSettings& settings,
                 const controller::Gaussian& belief, Draws draws);

  /// The mean cost of the paths under `policy`, with arbitrary gains.
  [[nodiscard]] double evaluate(const controller::Policy& policy);
  /// The mean cost of the paths under the policy with these nominal inputs (input_dim x horizon)
  /// and the corresponding regulator gains.
  [[nodiscard]] double evaluate(const Eigen::MatrixXd& inputs);
  /// The same, with its gradient (overwritten).
  double evaluate(const Eigen::MatrixXd& inputs, Eigen::MatrixXd& gradient);

  /// A local minimum within the input bounds from `start`, as accurate as kinks permit.
  [[nodiscard]] Eigen::MatrixXd descend(const Eigen::MatrixXd& start);

 private:
  [[nodiscard]] controller::Policy policy_of(const Eigen::MatrixXd& inputs) const;
  [[nodiscard]] std::vector<Eigen::MatrixXd> gains(const Eigen::MatrixXd& states,
                                                   const Eigen::MatrixXd& inputs) const;
  void forward(const controller::Policy& policy);
  void backward(const controller::Policy& policy, Eigen::MatrixXd& gradient);
  void add_gain_gradient(const Eigen::MatrixXd& inputs, Eigen::MatrixXd& gradient) const;
  void add_state_adjoint(Eigen::Index stage, const Eigen::MatrixXd& weight,
                         models::StateBatch& adjoint);
  double penalty(const models::StateBatch& states, models::StateBatch& slope) const;

  const models::Dynamics& dynamics_;
  controller::PlannerSettings settings_;
  Eigen::VectorXd start_;
  std::vector<models::StateBatch> states_;  // horizon + 1; stage 0 is the belief's draws
  std::vector<models::StateBatch> inputs_;  // horizon
  std::vector<models::StateBatch> noise_;   // horizon
  std::vector<models::StateBatch> penalty_slopes_;
  std::vector<Eigen::MatrixXd> gain_gradients_;
  double value_ = 0.0;
};

struct SearchSettings {
  Draws draws;
  int coarse_paths = 250;  ///< for the first search of local minima
  int random_starts = 4;
  unsigned seed = 1;     ///< of the random starts
  std::size_t kept = 3;  ///< minima that are refined on all paths
};

/// The end points of long descents. Descents on few paths, from random inputs and from inputs
/// constant in each half of the horizon, find the local minima; descents on all paths start from
/// `also` and from the best of those minima, and their end points are returned. Which one is best
/// must be decided on other draws: the prices of two minima may differ by less than the sampling
/// error.
[[nodiscard]] std::vector<Eigen::MatrixXd> deepest_inputs(
    const models::Dynamics& dynamics, const controller::PlannerSettings& settings,
    const controller::Gaussian& belief, const SearchSettings& search,
    const std::vector<Eigen::MatrixXd>& also);

}  // namespace qsmpc::testing
