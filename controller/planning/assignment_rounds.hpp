// The optimisation of a plan: a solver's run at assignments that are held, then a prediction with
// new ones, and again, as long as it pays.
#pragma once

#include <memory>

#include <Eigen/Core>

#include "controller/planning/plan_evaluator.hpp"
#include "controller/planning/plan_in_progress.hpp"
#include "controller/planning/planner_settings.hpp"
#include "controller/planning/solvers/augmented_lagrangian.hpp"
#include "controller/planning/solvers/ocp_solver.hpp"
#include "models/dynamics/dynamics.hpp"

namespace qsmpc::controller {

class AssignmentRounds {
 public:
  /// Refers to all three. Throws std::invalid_argument on an unknown solver.
  AssignmentRounds(const models::Dynamics& dynamics, const PlannerSettings& settings,
                   PlanEvaluator& evaluator);

  /// Makes plan.current the best plan, evaluated with assignments and gains of its own, from what
  /// it is now, at the assignments that are held: first the inputs are optimised, and then, if
  /// wanted, the gain with them, so that it never costs more. Trouble and a deadline that has
  /// passed are said in plan.status and plan.failed. Where the risk is limited, each prediction is
  /// certified; while a limit is exceeded, it is searched again, three times at most.
  void optimise(PlanInProgress& plan);

  /// Makes plan.current a plan of less risk, from what it is now, evaluated: the logarithm of the
  /// plan's risk is minimised, and the cost but to choose among equals. Once the limits are kept,
  /// `optimise` goes on from there.
  void reduce_risk(PlanInProgress& plan);

  /// Makes plan.current the plan that comes to rest soonest.
  void brake(PlanInProgress& plan);

 private:
  /// What the solver minimises.
  enum class Aim { kCost, kAugmented, kRisk };

  /// A problem with its solver, and the decision that they work on.
  struct Search {
    OcpProblem problem;
    std::unique_ptr<OcpSolver> solver;
    Eigen::VectorXd z;
    double least = 0.0;  // that the solver has found in its last run, at the assignments held then
  };

  void make_search(Eigen::Index entries, Search& out);
  void start(OcpSolver& solver, bool warm) const;
  [[nodiscard]] double evaluate(const Eigen::VectorXd& z, Eigen::VectorXd& gradient);
  [[nodiscard]] SolverOptions solver_options(const PlanInProgress& plan) const;
  [[nodiscard]] const SolverResult& minimise(Search& search, PlanInProgress& plan);
  [[nodiscard]] bool asks_for_more(const Plan& candidate, PlanInProgress& plan, int round,
                                   int& rounds) const;
  [[nodiscard]] bool optimise(Search& search, int rounds, PlanInProgress& plan);
  [[nodiscard]] bool run_solver(Search& search, PlanInProgress& plan);
  void predict_candidate(const Eigen::VectorXd& z, PlanInProgress& plan);

  const models::Dynamics& dynamics_;
  const PlannerSettings& settings_;
  PlanEvaluator& evaluator_;
  Search inputs_;
  std::unique_ptr<Search> gains_;  // over inputs and gains, where these are optimised
  Eigen::MatrixXd gain_change_;    // of a candidate
  double tolerance_ = 0.0;         // that the solver's own is raised to
  Aim aim_ = Aim::kCost;
  AugmentedLagrangian lagrangian_;
  double cost_share_ = 0.0;  // of the cost in what is minimised for the risk
  Eigen::VectorXd risk_gradient_;
};

}  // namespace qsmpc::controller
