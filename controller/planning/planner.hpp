// The receding-horizon planner (Algorithm 5): from a Gaussian belief to a policy over the horizon.
//
//   Planner planner(*car, settings);
//   const Plan& plan = planner.plan(belief);
//   Eigen::VectorXd u = policy_input(plan.policy, 0, measured_state);
//
// A planner remembers its last plan, from which the next one is started; apart from that, from the
// timings, and from a deadline if it has one, a plan depends on nothing but settings and beliefs.
// Once it has planned for beliefs of a kind, planning allocates nothing (but for what solvers of
// other people's and the slower propagators do).
#pragma once

#include <array>
#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "controller/measure/quantisation/gaussian_quantiser.hpp"
#include "controller/planning/cost/horizon_cost.hpp"
#include "controller/planning/cost/noise_free_cost.hpp"
#include "controller/planning/cost/particle_constraints.hpp"
#include "controller/planning/planner_settings.hpp"
#include "controller/planning/policy_maker.hpp"
#include "controller/planning/solvers/ocp_solver.hpp"
#include "controller/planning/start/first_guess.hpp"
#include "controller/planning/start/multi_start_search.hpp"
#include "controller/prediction/policy.hpp"
#include "controller/prediction/propagator.hpp"
#include "models/dynamics/dynamics.hpp"

namespace qsmpc::controller {

/// Wall-clock times in milliseconds.
struct PlanTiming {
  double quantise = 0.0;
  double propagate = 0.0;  ///< first guesses, linearisations, predictions with new assignments
  double optimise = 0.0;   ///< inside the solver
};

struct Plan {
  Policy policy;
  Eigen::MatrixXd gain_change;  ///< input_dim x state_dim, in all gains; zero unless optimised
  GaussianQuantisation belief;  ///< of stage 0
  Prediction prediction;        ///< under `policy`, with its own assignments
  CostParts cost;               ///< of `prediction`
  /// Of the solver's last run; kDeadline where the time was up, this being the best so far.
  SolverStatus status = SolverStatus::kConverged;
  double violation = 0.0;  ///< how far a particle is beyond the bounds at most, where the solver
                           ///< takes them as constraints; 0 elsewhere
  int evaluations = 0;     ///< of cost and gradient
  bool warm = false;       ///< the previous plan was the first guess
  bool fallback = false;   ///< nothing finite came out; this is the shifted previous plan
  PlanTiming timing;
};

class Planner {
 public:
  /// `dynamics` must outlive the planner. Throws std::invalid_argument on settings that make no
  /// sense: sizes, non-finite entries, unknown names, a horizon below 1.
  Planner(const models::Dynamics& dynamics, PlannerSettings settings);
  Planner(const Planner&) = delete;
  Planner& operator=(const Planner&) = delete;
  Planner(Planner&&) = delete;
  Planner& operator=(Planner&&) = delete;
  ~Planner() = default;

  /// Plans for `belief` (state_dim; checked, throws std::invalid_argument). Numerical trouble and
  /// a deadline that has passed are statuses of the plan, never exceptions; after a failure the
  /// next plan is a cold start. The plan stays valid until the next call.
  const Plan& plan(const Gaussian& belief);

  /// The plan whose nominal inputs are `inputs` (input_dim x horizon): predicted and evaluated for
  /// `belief`, with the gains that belong to them, and not optimised. The plan stays valid until
  /// the next call, which does not start from it. Throws std::invalid_argument as `plan`, and if
  /// the inputs are of another size, not finite or not within the bounds.
  const Plan& prescribe(const Gaussian& belief, const Eigen::Ref<const Eigen::MatrixXd>& inputs);

  /// Quantises a Gaussian of this covariance (state_dim x state_dim), so that the quantiser's slow
  /// first call for beliefs like it is over before a control loop starts. No plan depends on it.
  /// Throws std::invalid_argument as `plan`.
  void prepare(const Eigen::MatrixXd& covariance);

  /// Forgets the last plan: the next one is a cold start.
  void reset() {
    last_ = nullptr;
    failed_ = false;
  }

  [[nodiscard]] const PlannerSettings& settings() const { return settings_; }
  [[nodiscard]] const Propagator& propagator() const { return *propagator_; }
  [[nodiscard]] const models::Dynamics& dynamics() const { return dynamics_; }

 private:
  using Clock = std::chrono::steady_clock;
  /// One plan in the making.
  struct Round {
    Clock::time_point deadline;
    bool warm = false;       // whether it goes on from the last plan
    bool evaluated = false;  // whether `current_` is a plan with a prediction of its own
    SolverStatus status = SolverStatus::kConverged;
    int evaluations = 0;
    double tolerance = 0.0;  // that the solver's own is raised to
    PlanTiming timing;

    [[nodiscard]] bool stopped() const {
      return status == SolverStatus::kDeadline || status == SolverStatus::kNumericalTrouble;
    }
  };
  /// A problem with its solver, and the decision that they work on.
  struct Search {
    OcpProblem problem;
    std::unique_ptr<OcpSolver> solver;
    Eigen::VectorXd z;
    double least = 0.0;  // that the solver has found in its last run, at the assignments held then
  };

  void take_belief(const Gaussian& belief);
  void quantise_belief(const Gaussian& belief, GaussianQuantisation& out);
  [[nodiscard]] bool begin(const Gaussian& belief, Round& round);
  void make_search(Eigen::Index entries, Search& out);
  void start_solver(OcpSolver& solver, bool warm) const;
  [[nodiscard]] bool constant_is_clearly_cheaper(const Gaussian& belief, Round& round);
  [[nodiscard]] double evaluate_frozen(const Plan& plan);
  void set_policy(const Gaussian& belief, const Eigen::MatrixXd& inputs, Plan& plan);
  void start_from_best_candidate(const Gaussian& belief, Round& round);
  void optimise(const Gaussian& belief, Round& round);
  [[nodiscard]] bool optimise(const Gaussian& belief, Search& search, int rounds, Round& round);
  [[nodiscard]] bool run_solver(Search& search, Round& round);
  void predict_candidate(const Gaussian& belief, const Eigen::VectorXd& z);
  void fall_back(const Gaussian& belief);
  [[nodiscard]] bool maps_fit(const Plan& plan) const;
  void predict_and_evaluate(Plan& plan);
  void freeze_assignments(const Prediction& prediction, const Policy& policy);
  static void flatten(const Policy& policy, Eigen::VectorXd& z);
  [[nodiscard]] bool better(const Plan& plan, const Plan& other) const;

  const models::Dynamics& dynamics_;
  PlannerSettings settings_;
  QuadraticCost weights_;            // the cost about the target that is nearest to the belief
  bool constrained_;                 // whether the solver takes constraints
  Penalty penalty_;                  // what of the penalties is left to the cost
  Eigen::MatrixXd predicted_noise_;  // what of the noise the prediction carries
  Eigen::MatrixXd no_noise_;
  Eigen::MatrixXd within_;  // covariance that the belief's quantiser loses
  std::unique_ptr<Propagator> propagator_;
  PolicyMaker policies_;
  HorizonCost cost_;
  NoiseFreeCost noise_free_;
  FirstGuess guess_;
  std::optional<MultiStartSearch> minima_;  // where there are obstacles
  ParticleConstraints constraints_;
  Search inputs_;
  std::unique_ptr<Search> gain_search_;  // over inputs and gains, where these are optimised
  PredictionScratch scratch_;
  Eigen::VectorXd constraint_values_;
  Eigen::MatrixXd gain_change_;
  std::chrono::duration<double> prediction_time_{0.0};  // of the last one

  std::optional<GaussianQuantisation> known_belief_;  // about zero, for `known_covariance_`
  Eigen::MatrixXd known_covariance_;
  GaussianQuantisation belief_;
  std::array<Plan, 3> plans_;
  Plan* last_ = nullptr;       // the plan last made, null for a cold start
  Plan* current_ = nullptr;    // best so far of the plan in the making
  Plan* candidate_ = nullptr;  // what may replace it
  bool failed_ = false;        // the last plan fell back, or its solver met numerical trouble
  Plan prescribed_;
};

/// What `plan`, which `planner` made for `belief`, predicts; refers to all three.
[[nodiscard]] PredictedMotion motion_of(const Planner& planner, const Gaussian& belief,
                                        const Plan& plan);

}  // namespace qsmpc::controller
