// The optimisation of a plan: a solver run with fixed assignments, then a prediction with new ones,
// repeated as long as it pays.
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
  /// Keeps references to all three. Throws std::invalid_argument on an unknown solver.
  AssignmentRounds(const models::Dynamics& dynamics, const PlannerSettings& settings,
                   PlanEvaluator& evaluator);

  /// Optimises plan.current, from its present state and the held assignments, into the best plan,
  /// evaluated with its own assignments and gains: first the inputs and then, if requested, the
  /// gain together with them, so that the cost never increases. Numerical trouble and a missed
  /// deadline are reported in plan.status and plan.failed. Where the risk is limited, each
  /// prediction is certified; while a limit is exceeded, the search is repeated, at most three
  /// times.
  void optimise(PlanInProgress& plan);

  /// Reduces the risk of plan.current, which must be evaluated: minimises the logarithm of its
  /// risk, with the cost only as a tie-breaker. Stops once the limits are kept; the next plan's
  /// `optimise` continues from there.
  void reduce_risk(PlanInProgress& plan);

  /// Replaces plan.current by the plan that comes to rest soonest.
  void brake(PlanInProgress& plan);

 private:
  /// What the solver minimises.
  enum class Aim { kCost, kAugmented, kRisk };

  /// A problem with its solver and decision vector.
  struct Search {
    OcpProblem problem;
    std::unique_ptr<OcpSolver> solver;
    Eigen::VectorXd z;
    double least = 0.0;  // lowest cost of the solver's last run, at the assignments held then
  };

  void make_search(Eigen::Index entries, Search& out);
  void start(OcpSolver& solver, bool warm) const;
  [[nodiscard]] double cost_of(const Eigen::VectorXd& z);
  [[nodiscard]] double evaluate(const Eigen::VectorXd& z, Eigen::VectorXd& gradient);
  [[nodiscard]] SolverOptions solver_options(const PlanInProgress& plan) const;
  [[nodiscard]] const SolverResult& minimise(Search& search, PlanInProgress& plan);
  [[nodiscard]] double first_tolerance(const PlanInProgress& plan) const;
  [[nodiscard]] bool asks_for_more(const Plan& candidate, PlanInProgress& plan, int round,
                                   int& rounds) const;
  [[nodiscard]] bool optimise(Search& search, int rounds, PlanInProgress& plan);
  [[nodiscard]] bool run_solver(Search& search, PlanInProgress& plan);
  void set_candidate(const Eigen::VectorXd& z, PlanInProgress& plan);
  [[nodiscard]] bool predict_candidate(PlanInProgress& plan);

  const models::Dynamics& dynamics_;
  const PlannerSettings& settings_;
  PlanEvaluator& evaluator_;
  Search inputs_;
  std::unique_ptr<Search> gains_;  // over inputs and gains, if these are optimised
  Eigen::MatrixXd gain_change_;    // of a candidate
  double tolerance_ = 0.0;         // lower limit of the solver's own
  double change_ = 0.0;            // relative, of the cost at the last new assignments
  Aim aim_ = Aim::kCost;
  CoarseCost* coarse_ = nullptr;  // what the solver sees of the cost; null: all of it
  AugmentedLagrangian lagrangian_;
  double cost_share_ = 0.0;  // weight of the cost when the risk is minimised
  Eigen::VectorXd risk_gradient_;
};

}  // namespace qsmpc::controller
