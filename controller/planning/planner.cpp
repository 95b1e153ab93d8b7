#include "controller/planning/planner.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "controller/planning/cost/angular_target.hpp"
#include "models/constants.hpp"

namespace qsmpc::controller {
namespace {

// Rounds of "optimise at frozen assignments, then predict with new ones" in one plan.
constexpr int kAssignmentRounds = 3;
// The same with the gains among what is optimised.
constexpr int kGainRounds = 2;
// On a warm start the rounds need not be more precise than this, relatively: the next period goes
// on.
constexpr double kWarmTolerance = 1e-7;
// The first round of a cold start need be no more precise than this, relatively, as new assignments
// will change the problem, and the following ones than this share of the last change.
constexpr double kColdTolerance = 1e-5;
constexpr double kShareOfChange = 0.01;
// What a round must promise of the cost, relatively, to be worth a prediction, warm or cold.
constexpr double kWarmSettled = 1e-5;
constexpr double kColdSettled = 1e-6;
// How far a particle may be beyond a bound (m, or the state's unit) and still count as within.
constexpr double kConstraintTolerance = 1e-6;
// Further rounds where a particle is beyond a bound with new assignments, though none was with the
// old ones. Each asks for as much more room as was lacking.
constexpr int kConstraintRounds = 5;

class Stopwatch {
 public:
  /// Adds the milliseconds since construction or the last call to `total`.
  void add_to(double& total) {
    const auto now = Clock::now();
    total += std::chrono::duration<double, std::milli>(now - last_).count();
    last_ = now;
  }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point last_ = Clock::now();
};

// A message that is made only where it is needed: planning allocates nothing.
void require(bool holds, const char* message) {
  if (!holds) throw std::invalid_argument(std::string("planner: ") + message);
}

PlannerSettings checked(PlannerSettings settings, const models::Dynamics& dynamics) {
  check_planner_settings(settings, dynamics.state_dim(), dynamics.input_dim());
  return settings;
}

PropagatorSettings propagation(const PlannerSettings& settings) {
  return {.noise = {.mean = Eigen::VectorXd::Zero(settings.noise_covariance.rows()),
                    .covariance = settings.noise_covariance},
          .noise_points = settings.noise_points,
          .compressed_points = settings.compressed_points};
}

}  // namespace

Planner::Planner(const models::Dynamics& dynamics, PlannerSettings settings)
    : dynamics_(dynamics),
      settings_(checked(std::move(settings), dynamics)),
      weights_(settings_.cost),
      constrained_(settings_.solver == "slsqp"),
      penalty_(settings_.penalty),
      predicted_noise_(settings_.propagator == "noise_free"
                           ? Eigen::MatrixXd::Zero(dynamics.state_dim(), dynamics.state_dim())
                           : settings_.noise_covariance),
      no_noise_(Eigen::MatrixXd::Zero(dynamics.state_dim(), dynamics.state_dim())),
      within_(no_noise_),
      propagator_(make_propagator(settings_.propagator, propagation(settings_))),
      policies_(dynamics_, settings_),
      cost_({.dynamics = dynamics_,
             .safe_set = settings_.safe_set,
             .cost = weights_,
             .penalty = constrained_ ? (penalty_.box = 0.0, penalty_) : penalty_,
             .noise_covariance = predicted_noise_,
             .within_covariance = within_},
            settings_.run),
      noise_free_(settings_.horizon, {.dynamics = dynamics_,
                                      .safe_set = settings_.safe_set,
                                      .cost = weights_,
                                      .penalty = settings_.penalty,
                                      .noise_covariance = no_noise_,
                                      .within_covariance = no_noise_}),
      guess_(settings_),
      constraints_(cost_, settings_.safe_set),
      gain_change_(Eigen::MatrixXd::Zero(dynamics.input_dim(), dynamics.state_dim())) {
  if (!settings_.safe_set.obstacles.empty()) minima_.emplace(settings_, noise_free_);
  make_search(0, inputs_);
  if (settings_.closed_loop && settings_.optimise_gain) {
    gain_search_ = std::make_unique<Search>();
    make_search(gain_change_.size(), *gain_search_);
  }
}

/// Over the inputs of all stages and `entries` entries of the gains, which are not bounded.
void Planner::make_search(Eigen::Index entries, Search& out) {
  const Eigen::Index inputs = Eigen::Index{dynamics_.input_dim()} * settings_.horizon;
  out.problem.lower.setConstant(inputs + entries, -kInfinity);
  out.problem.upper.setConstant(inputs + entries, kInfinity);
  out.problem.lower.head(inputs) = settings_.bounds.lower.replicate(settings_.horizon, 1);
  out.problem.upper.head(inputs) = settings_.bounds.upper.replicate(settings_.horizon, 1);
  out.problem.cost = [this](const Eigen::VectorXd& z, Eigen::VectorXd& gradient) {
    return cost_.evaluate(z, gradient);
  };
  if (constrained_) out.problem.constraints.emplace();
  out.solver = make_solver(settings_.solver, {.bounding = settings_.input_bounding});
  out.z.resize(inputs + entries);
}

const Plan& Planner::plan(const Gaussian& belief) {
  Round round;
  round.deadline = Clock::time_point::max();
  if (std::isfinite(settings_.deadline)) {
    round.deadline = Clock::now() + std::chrono::duration_cast<Clock::duration>(
                                        std::chrono::duration<double>(settings_.deadline));
  }
  std::array<Plan*, 2> spare{};
  for (std::size_t n = 0, to = 0; n < plans_.size() && to < spare.size(); ++n) {
    if (&plans_[n] != last_) spare[to++] = &plans_[n];
  }
  current_ = spare[0];
  candidate_ = spare[1];
  round.warm = begin(belief, round);
  optimise(belief, round);
  bool fallback = false;
  if (!std::isfinite(current_->cost.total()) && last_ != nullptr) {
    fall_back(belief);
    fallback = true;
  }
  // A place in which no plan has been finished yet is made ready at once, not in some later period.
  for (Plan& plan : plans_) {
    if (&plan == current_ || plan.belief.measure.size() == 0) plan.belief = belief_;
  }
  current_->status = round.status;
  current_->evaluations = round.evaluations;
  current_->warm = round.warm;
  current_->fallback = fallback;
  current_->timing = round.timing;
  failed_ = fallback || round.status == SolverStatus::kNumericalTrouble;
  last_ = current_;
  return *last_;
}

/// Quantises the belief, chooses where to start, and holds assignments that may do for the start:
/// those of the last plan, if that is where the start is from, or else new ones. Returns whether
/// it is.
bool Planner::begin(const Gaussian& belief, Round& round) {
  Stopwatch stopwatch;
  take_belief(belief);
  stopwatch.add_to(round.timing.quantise);
  const Plan* const previous = failed_ ? nullptr : last_;
  if (previous != nullptr) {
    gain_change_ = previous->gain_change;
  } else {
    gain_change_.setZero();
  }
  noise_free_.place(belief);
  bool warm = guess_.compare(previous != nullptr ? &previous->policy.inputs : nullptr, gain_change_,
                             noise_free_, policies_);
  if (warm) {
    set_policy(belief, guess_.shifted(), *current_);
    if (maps_fit(*last_)) {
      last_->prediction.stages[0] = belief_.measure;
      freeze_assignments(last_->prediction, current_->policy);
    } else {
      predict_and_evaluate(*current_);
      round.evaluated = true;
    }
    warm = !constant_is_clearly_cheaper(belief, round);
  }
  start_solver(*inputs_.solver, warm);
  if (gain_search_) start_solver(*gain_search_->solver, warm);
  if (!warm && minima_) {
    start_from_best_candidate(belief, round);
  } else if (!warm && round.evaluated) {
    std::swap(current_, candidate_);  // the constant inputs, which won
    freeze_assignments(current_->prediction, current_->policy);
  } else if (!warm) {
    set_policy(belief, guess_.constant(), *current_);
    predict_and_evaluate(*current_);
    round.evaluated = true;
  }
  stopwatch.add_to(round.timing.propagate);
  return warm;
}

/// Whether the best constant inputs are clearly cheaper than the shifted previous plan, which is
/// `current_`, with the noise, too. Where the assignments that are held do not rule it out, both
/// are predicted. Leaves the assignments for `current_` held.
bool Planner::constant_is_clearly_cheaper(const Gaussian& belief, Round& round) {
  // Without noise many a constant looks better than a plan that is careful because of it.
  if (!(guess_.advantage() > 0.0)) return false;
  set_policy(belief, guess_.constant(), *candidate_);
  if (!round.evaluated) {
    const double shifted = evaluate_frozen(*current_);
    freeze_assignments(last_->prediction, candidate_->policy);
    const bool possible = clearly_cheaper(evaluate_frozen(*candidate_), shifted);
    if (!possible || Clock::now() >= round.deadline) {
      freeze_assignments(last_->prediction, current_->policy);
      return false;
    }
  }
  predict_and_evaluate(*candidate_);
  if (round.evaluated) {
    freeze_assignments(current_->prediction, current_->policy);
  } else {
    predict_and_evaluate(*current_);
    round.evaluated = true;
  }
  return clearly_cheaper(candidate_->cost.total(), current_->cost.total());
}

/// What the assignments that are held say of the plan's cost.
double Planner::evaluate_frozen(const Plan& plan) {
  flatten(plan.policy, inputs_.z);
  return cost_.evaluate(inputs_.z);
}

/// Makes `plan` about `inputs`, with the gains that belong to them.
void Planner::set_policy(const Gaussian& belief, const Eigen::MatrixXd& inputs, Plan& plan) {
  plan.gain_change = gain_change_;
  policies_.make(belief.mean, inputs, gain_change_, plan.policy);
}

/// Makes `current_` the cheapest, as predicted with noise, of the multi-start search's candidates
/// and of itself if it has been evaluated, and freezes its assignments.
void Planner::start_from_best_candidate(const Gaussian& belief, Round& round) {
  bool held = round.evaluated;
  for (const Eigen::MatrixXd* const inputs : minima_->search(policies_, round.deadline)) {
    if (round.evaluated && Clock::now() >= round.deadline) break;
    Plan& plan = round.evaluated ? *candidate_ : *current_;
    set_policy(belief, *inputs, plan);
    predict_and_evaluate(plan);
    held = !round.evaluated || better(plan, *current_);
    if (held && round.evaluated) std::swap(current_, candidate_);
    round.evaluated = true;
  }
  if (!held) freeze_assignments(current_->prediction, current_->policy);
}
void Planner::start_solver(OcpSolver& solver, bool warm) const {
  if (warm) {
    solver.shift({.inputs_per_stage = dynamics_.input_dim(), .horizon = settings_.horizon});
  } else {
    solver.forget();
  }
}

/// Whether the plan's assignments can be held for the belief at hand.
bool Planner::maps_fit(const Plan& plan) const {
  const Prediction& prediction = plan.prediction;
  return prediction.stages[0].weights.size() == belief_.measure.weights.size() &&
         prediction.stages[0].weights == belief_.measure.weights &&
         std::all_of(prediction.maps.begin(), prediction.maps.end(),
                     [](const StageMap& map) { return std::isfinite(map.compression_w2); });
}

/// Leaves in `current_` the best plan, evaluated with assignments and gains of its own: first the
/// inputs are optimised, and then, if wanted, the gain with them, so that it never costs more.
void Planner::optimise(const Gaussian& belief, Round& round) {
  constraints_.set_margin(0.0);
  const int rounds = kAssignmentRounds + (round.evaluated ? 0 : 1);
  // Constraints are met by rounds that are precise, or else by none; and gains are searched for
  // about inputs that have converged.
  const bool loose = !round.warm && !constrained_ && !gain_search_;
  round.tolerance = loose ? kColdTolerance : 0.0;
  if (optimise(belief, inputs_, rounds, round) && gain_search_) {
    // What was predicted last may be a candidate that was refused.
    freeze_assignments(current_->prediction, current_->policy);
    (void)optimise(belief, *gain_search_, kGainRounds, round);
  }
  if (round.stopped()) return;
  if (current_->violation > kConstraintTolerance) {
    round.status = SolverStatus::kInfeasible;
  } else if (round.status == SolverStatus::kInfeasible) {
    // Of a search for something better than the plan that is kept.
    round.status = SolverStatus::kStalled;
  }
}

/// Rounds of one search. Returns whether another one may follow.
bool Planner::optimise(const Gaussian& belief, Search& search, int rounds, Round& round) {
  Stopwatch stopwatch;
  const int most_rounds = rounds + kConstraintRounds;
  const auto may_go_on = [&] {
    return round.evaluations < settings_.max_evaluations && !round.stopped();
  };
  for (int n = 0; n < rounds && may_go_on(); ++n) {
    const bool promising = run_solver(search, round);
    stopwatch.add_to(round.timing.optimise);
    if (!promising) {
      if (round.tolerance == 0.0) break;
      round.tolerance = 0.0;
      --n;  // no prediction was needed
      continue;
    }
    predict_candidate(belief, search.z);
    stopwatch.add_to(round.timing.propagate);
    if (round.tolerance > 0.0) {
      const double change = std::abs(candidate_->cost.total() / search.least - 1.0);
      round.tolerance = std::min(round.tolerance, kShareOfChange * change);
    }
    const double excess = candidate_->violation;
    const bool accepted = !round.evaluated || better(*candidate_, *current_);
    if (accepted) {
      std::swap(current_, candidate_);
      round.evaluated = true;
    }
    if (Clock::now() >= round.deadline) round.status = SolverStatus::kDeadline;
    if (excess > kConstraintTolerance && round.status != SolverStatus::kInfeasible) {
      constraints_.set_margin(constraints_.margin() + excess);
      rounds = std::clamp(n + 2, rounds, most_rounds);
    } else if (!accepted) {
      break;
    }
  }
  if (!round.evaluated) predict_and_evaluate(*current_);
  round.evaluated = true;
  stopwatch.add_to(round.timing.propagate);
  return may_go_on();
}

/// Makes `candidate_` the plan of the decision z.
void Planner::predict_candidate(const Gaussian& belief, const Eigen::VectorXd& z) {
  const Policy& policy = current_->policy;
  const Eigen::Index inputs = policy.inputs.size();
  candidate_->gain_change = current_->gain_change;
  if (z.size() > inputs) {
    candidate_->gain_change +=
        z.tail(gain_change_.size()).reshaped(gain_change_.rows(), gain_change_.cols());
  }
  policies_.make(belief.mean, z.head(inputs).reshaped(policy.inputs.rows(), settings_.horizon),
                 candidate_->gain_change, candidate_->policy);
  predict_and_evaluate(*candidate_);
}

/// Optimises at the assignments that are held, from `current_`; the result is in search.z. Returns
/// whether it is worth a prediction: finite, better by more than nothing, and in time.
bool Planner::run_solver(Search& search, Round& round) {
  flatten(current_->policy, search.z);
  SolverOptions options{.max_evaluations = settings_.max_evaluations - round.evaluations,
                        .constraint_tolerance = kConstraintTolerance};
  if (round.warm) options.relative_tolerance = kWarmTolerance;
  options.relative_tolerance = std::max(options.relative_tolerance, round.tolerance);
  if (round.deadline != Clock::time_point::max()) {
    // Time for the prediction that belongs to the result.
    options.deadline =
        round.deadline - std::chrono::duration_cast<Clock::duration>(prediction_time_);
  }
  const SolverResult& result = search.solver->minimise(search.problem, search.z, options);
  round.evaluations += result.evaluations;
  round.status = result.status;
  search.least = result.value;
  if (!std::isfinite(result.value)) {
    // Without time for a single evaluation there is no value, and the plan stands as it is.
    const bool trouble = result.status == SolverStatus::kNumericalTrouble;
    if (round.evaluated && trouble) current_->cost.state = result.value;
    return false;
  }
  search.z = result.z;
  if (!round.evaluated) return true;
  if (Clock::now() >= round.deadline) return false;
  const double gain = current_->cost.total() - result.value;
  const double settled = round.warm ? kWarmSettled : kColdSettled;
  return gain > settled * std::abs(current_->cost.total()) ||
         current_->violation > std::max(kConstraintTolerance, result.violation);
}

/// Feasible before infeasible, then the cheaper; of two that are infeasible the nearer.
bool Planner::better(const Plan& plan, const Plan& other) const {
  const bool feasible = plan.violation <= kConstraintTolerance;
  const bool other_feasible = other.violation <= kConstraintTolerance;
  if (feasible != other_feasible) return feasible;
  if (!feasible && plan.violation != other.violation) return plan.violation < other.violation;
  return plan.cost.total() < other.cost.total() || !std::isfinite(other.cost.total());
}

/// Nothing usable came out: goes on with what was planned before.
void Planner::fall_back(const Gaussian& belief) {
  Eigen::MatrixXd inputs;
  shift_inputs(last_->policy.inputs, inputs);
  current_->gain_change = last_->gain_change;
  policies_.make(belief.mean, inputs, current_->gain_change, current_->policy);
  predict_and_evaluate(*current_);
}

void Planner::freeze_assignments(const Prediction& prediction, const Policy& policy) {
  cost_.freeze_assignments(prediction, policy);
  if (!constrained_) return;
  constraints_.describe(prediction, *inputs_.problem.constraints);
  if (gain_search_) gain_search_->problem.constraints = inputs_.problem.constraints;
}

void Planner::flatten(const Policy& policy, Eigen::VectorXd& z) {
  z.setZero();
  z.head(policy.inputs.size()) = policy.inputs.reshaped();
}

/// Predicts under plan.policy with assignments of its own, freezes them, and evaluates the cost.
void Planner::predict_and_evaluate(Plan& plan) {
  const auto start = Clock::now();
  predict(dynamics_, *propagator_, belief_.measure, plan.policy, settings_.run, scratch_,
          plan.prediction);
  freeze_assignments(plan.prediction, plan.policy);
  flatten(plan.policy, inputs_.z);
  cost_.evaluate(inputs_.z);
  plan.cost = cost_.parts();
  plan.violation = 0.0;
  if (constrained_) {
    constraint_values_.resize(inputs_.problem.constraints->count);
    inputs_.problem.constraints->values(inputs_.z, constraint_values_);
    plan.violation = std::max(0.0, constraint_values_.maxCoeff() - constraints_.margin());
  }
  prediction_time_ = Clock::now() - start;
}

const Plan& Planner::prescribe(const Gaussian& belief,
                               const Eigen::Ref<const Eigen::MatrixXd>& inputs) {
  const InputBounds& bounds = settings_.bounds;
  require(inputs.rows() == dynamics_.input_dim() && inputs.cols() == settings_.horizon,
          "the inputs must be a matrix of inputs x stages");
  // A comparison with NaN is false, so these are refused as well.
  require(((inputs.colwise() - bounds.lower).array() >= 0.0).all() &&
              ((inputs.colwise() - bounds.upper).array() <= 0.0).all(),
          "the inputs must be within their bounds");
  Stopwatch stopwatch;
  prescribed_ = {};
  take_belief(belief);
  prescribed_.belief = belief_;
  stopwatch.add_to(prescribed_.timing.quantise);
  prescribed_.gain_change.setZero(gain_change_.rows(), gain_change_.cols());
  policies_.make(belief.mean, inputs, prescribed_.gain_change, prescribed_.policy);
  predict_and_evaluate(prescribed_);
  stopwatch.add_to(prescribed_.timing.propagate);
  return prescribed_;
}

void Planner::prepare(const Eigen::MatrixXd& covariance) {
  GaussianQuantisation unused;
  quantise_belief({.mean = Eigen::VectorXd::Zero(dynamics_.state_dim()), .covariance = covariance},
                  unused);
}

/// Quantises the belief, and places the target that the cost is about: the same one for the whole
/// plan, so that there is no kink between particles. The belief is checked before it is used.
void Planner::take_belief(const Gaussian& belief) {
  quantise_belief(belief, belief_);
  within_ = belief_.within_covariance;
  nearest_target(settings_.cost.target, settings_.cost.angles, belief.mean, weights_.target);
}

void Planner::quantise_belief(const Gaussian& belief, GaussianQuantisation& out) {
  const Eigen::Index dim = dynamics_.state_dim();
  require(belief.mean.size() == dim, "the belief must be of the state's dimension");
  require(belief.covariance.rows() == dim && belief.covariance.cols() == dim &&
              belief.covariance.allFinite(),
          "the belief's covariance must be a finite matrix of states x states");
  require(belief.mean.allFinite(), "the belief's mean must be finite");
  if (!known_belief_ || known_covariance_ != belief.covariance) {
    const Gaussian centred{.mean = Eigen::VectorXd::Zero(dim), .covariance = belief.covariance};
    known_belief_ = quantise(centred, settings_.state_points, settings_.quantiser);
    known_covariance_ = belief.covariance;
  }
  out = *known_belief_;
  out.measure.locations.colwise() += belief.mean;
}

PredictedMotion motion_of(const Planner& planner, const Gaussian& belief, const Plan& plan) {
  return {.dynamics = planner.dynamics(),
          .noise_covariance = planner.settings().noise_covariance,
          .noise_w2 = planner.propagator().noise_w2(),
          .belief = belief,
          .belief_w2 = plan.belief.w2,
          .policy = plan.policy,
          .prediction = plan.prediction};
}

}  // namespace qsmpc::controller
