#include "controller/planning/planner.hpp"

#include <array>
#include <chrono>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>
#include <vector>

namespace qsmpc {
namespace {

// Rounds of "predict with new assignments, then optimise at frozen ones" in one plan.
constexpr int kAssignmentRounds = 3;
// Relative change of the cost between rounds below which the assignments count as settled.
constexpr double kSettled = 1e-4;
// A guess must promise this fraction less cost to replace the shifted previous plan: switching
// sides of an obstacle for less makes the vehicle waver.
constexpr double kSwitchGain = 0.02;
// Relative; what rounding leaves in a symmetric matrix that was computed.
constexpr double kSymmetryTolerance = 1e-12;

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

void require(bool holds, const std::string& message) {
  if (!holds) throw std::invalid_argument("planner: " + message);
}

void require_square(const Eigen::MatrixXd& matrix, Eigen::Index size, const std::string& name) {
  require(
      matrix.rows() == size && matrix.cols() == size && matrix.allFinite(),
      name + " must be a finite matrix of " + std::to_string(size) + " x " + std::to_string(size));
}

/// The gradient of xᵀWx is written as 2Wx.
void require_symmetric(const Eigen::MatrixXd& matrix, const std::string& name) {
  require(matrix.isApprox(matrix.transpose(), kSymmetryTolerance), name + " must be symmetric");
}

void check_settings(const PlannerSettings& settings, int state_dim, int input_dim) {
  require(settings.horizon >= 1, "the horizon must be at least 1");
  require(settings.max_evaluations >= 1, "at least one evaluation of the cost is needed");
  require(settings.state_points >= 1, "at least one point is needed for the belief");
  require_square(settings.noise_covariance, state_dim, "the noise covariance");
  require_square(settings.cost.state, state_dim, "the state cost");
  require_square(settings.cost.terminal, state_dim, "the terminal cost");
  require_square(settings.cost.input, input_dim, "the input cost");
  require_symmetric(settings.cost.state, "the state cost");
  require_symmetric(settings.cost.terminal, "the terminal cost");
  require_symmetric(settings.cost.input, "the input cost");
  require(settings.cost.target.size() == state_dim && settings.cost.target.allFinite(),
          "the target must be a finite state");
  require(settings.penalty.length > 0.0, "the penalty's length must be positive");
  require(settings.penalty.box >= 0.0 && settings.penalty.obstacle >= 0.0,
          "penalty weights must not be negative");
  require(settings.safe_set.dim() == state_dim, "the safe set must be of the state's dimension");
  require(settings.bounds.lower.size() == input_dim && settings.bounds.upper.size() == input_dim &&
              settings.bounds.lower.allFinite() && settings.bounds.upper.allFinite() &&
              (settings.bounds.lower.array() < settings.bounds.upper.array()).all(),
          "the input bounds must be finite, lower < upper");
  if (settings.feedback_gain) {
    require(settings.feedback_gain->rows() == input_dim &&
                settings.feedback_gain->cols() == state_dim && settings.feedback_gain->allFinite(),
            "the feedback gain must be a finite matrix of inputs x states");
  }
  check_safe_set(settings.safe_set);
}

/// The inputs of the previous plan, one stage later; the last is held.
Eigen::MatrixXd shifted(const Eigen::MatrixXd& inputs) {
  Eigen::MatrixXd result = inputs;
  result.leftCols(inputs.cols() - 1) = inputs.rightCols(inputs.cols() - 1);
  return result;
}

}  // namespace

Planner::Planner(const Dynamics& dynamics, PlannerSettings settings)
    : dynamics_(dynamics), settings_(std::move(settings)) {
  const int dim = dynamics.state_dim();
  check_settings(settings_, dim, dynamics.input_dim());
  const PropagatorSettings propagation{
      .noise = {.mean = Eigen::VectorXd::Zero(dim), .covariance = settings_.noise_covariance},
      .noise_points = settings_.noise_points,
      .compressed_points = settings_.compressed_points};
  propagator_ = make_propagator(settings_.propagator, propagation);
  noise_free_ = make_propagator("noise_free", propagation);
  solver_ = make_solver(settings_.solver);
  predicted_noise_ = settings_.propagator == "noise_free" ? Eigen::MatrixXd::Zero(dim, dim)
                                                          : settings_.noise_covariance;
}

const Plan& Planner::plan(const Gaussian& belief) {
  Stopwatch stopwatch;
  Plan plan;
  plan.belief = quantise_belief(belief);
  stopwatch.add_to(plan.timing.quantise);
  const Eigen::MatrixXd guess = first_guess(belief, plan.belief);
  plan.policy = make_policy(belief.mean, guess);
  plan.prediction = predict(dynamics_, *propagator_, plan.belief.measure, plan.policy);
  plan.cost = cost_of(plan);
  stopwatch.add_to(plan.timing.propagate);
  optimise(belief, plan);
  if (!std::isfinite(plan.cost.total()) && plan_) {
    // Nothing usable came out: go on with what was planned before.
    plan.policy = make_policy(belief.mean, shifted(plan_->policy.inputs));
    plan.prediction = predict(dynamics_, *propagator_, plan.belief.measure, plan.policy);
    plan.cost = cost_of(plan);
    plan.fallback = true;
  }
  plan_ = std::move(plan);
  return *plan_;
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
  prescribed_.belief = quantise_belief(belief);
  stopwatch.add_to(prescribed_.timing.quantise);
  prescribed_.policy = make_policy(belief.mean, inputs);
  prescribed_.prediction =
      predict(dynamics_, *propagator_, prescribed_.belief.measure, prescribed_.policy);
  prescribed_.cost = cost_of(prescribed_);
  stopwatch.add_to(prescribed_.timing.propagate);
  return prescribed_;
}

void Planner::prepare(const Eigen::MatrixXd& covariance) {
  (void)quantise_belief(
      {.mean = Eigen::VectorXd::Zero(dynamics_.state_dim()), .covariance = covariance});
}

HorizonCostTerms Planner::terms(const Eigen::MatrixXd& noise_covariance,
                                const GaussianQuantisation& belief) const {
  return {.dynamics = dynamics_,
          .safe_set = settings_.safe_set,
          .cost = settings_.cost,
          .penalty = settings_.penalty,
          .noise_covariance = noise_covariance,
          .within_covariance = belief.within_covariance};
}

GaussianQuantisation Planner::quantise_belief(const Gaussian& belief) {
  require(belief.mean.size() == dynamics_.state_dim(),
          "the belief must be of the state's dimension");
  require_square(belief.covariance, dynamics_.state_dim(), "the belief's covariance");
  require(belief.mean.allFinite(), "the belief's mean must be finite");
  if (!last_belief_ || last_covariance_ != belief.covariance) {
    const Gaussian centred{.mean = Eigen::VectorXd::Zero(belief.mean.size()),
                           .covariance = belief.covariance};
    last_belief_ = quantise(centred, settings_.state_points, settings_.quantiser);
    last_covariance_ = belief.covariance;
  }
  GaussianQuantisation result = *last_belief_;
  result.measure.locations.colwise() += belief.mean;
  return result;
}

Policy Planner::make_policy(const Eigen::VectorXd& start, const Eigen::MatrixXd& inputs) const {
  Policy policy{.inputs = inputs,
                .states = nominal_states(dynamics_, start, inputs),
                .gains = {},
                .bounds = settings_.bounds};
  if (!settings_.closed_loop) {
    policy.gains.assign(settings_.horizon,
                        Eigen::MatrixXd::Zero(inputs.rows(), policy.states.rows()));
  } else if (settings_.feedback_gain) {
    policy.gains.assign(settings_.horizon, *settings_.feedback_gain);
  } else {
    // The curvature of the cost: ½ x'Qx, u'Ru and x'Px have the Hessians Q, 2R and 2P.
    policy.gains = lqr_gains(dynamics_, policy.states, inputs,
                             {.state = settings_.cost.state,
                              .input = 2.0 * settings_.cost.input,
                              .terminal = 2.0 * settings_.cost.terminal});
  }
  return policy;
}

// The cost has a valley for each way round each obstacle. The shifted previous plan is the first
// choice; constant inputs, priced on the belief's points alone, show whether another valley is
// clearly deeper.
Eigen::MatrixXd Planner::first_guess(const Gaussian& belief,
                                     const GaussianQuantisation& quantised) const {
  const InputBounds& bounds = settings_.bounds;
  const Eigen::VectorXd middle = 0.5 * (bounds.lower + bounds.upper);
  std::vector<Eigen::VectorXd> constants = {middle};
  for (const double share : {-0.9, -0.45, 0.45, 0.9}) {
    for (Eigen::Index input = 0; input < middle.size(); ++input) {
      constants.push_back(middle);
      constants.back()[input] += 0.5 * share * (bounds.upper[input] - bounds.lower[input]);
    }
  }
  Eigen::MatrixXd best = middle.replicate(1, settings_.horizon);
  double least = std::numeric_limits<double>::infinity();
  if (plan_) {
    const Eigen::MatrixXd warm = shifted(plan_->policy.inputs);
    const double warm_cost = cost_without_noise(belief, quantised, warm);
    if (std::isfinite(warm_cost)) {
      best = warm;
      least = warm_cost - kSwitchGain * std::abs(warm_cost);
    }
  }
  for (const Eigen::VectorXd& constant : constants) {
    const Eigen::MatrixXd guess = constant.replicate(1, settings_.horizon);
    const double cost = cost_without_noise(belief, quantised, guess);
    if (cost < least) {
      least = cost;
      best = guess;
    }
  }
  return best;
}

double Planner::cost_without_noise(const Gaussian& belief, const GaussianQuantisation& quantised,
                                   const Eigen::MatrixXd& inputs) const {
  const Policy policy = make_policy(belief.mean, inputs);
  const Prediction prediction = predict(dynamics_, *noise_free_, quantised.measure, policy);
  const Eigen::MatrixXd none = Eigen::MatrixXd::Zero(belief.mean.size(), belief.mean.size());
  HorizonCost cost(terms(none, quantised), prediction, policy);
  Eigen::MatrixXd gradient(inputs.rows(), inputs.cols());
  const double value = cost.evaluate(inputs, gradient);
  // A guess whose cost is not a number must lose every comparison.
  return std::isnan(value) ? std::numeric_limits<double>::infinity() : value;
}

void Planner::optimise(const Gaussian& belief, Plan& plan) const {
  Stopwatch stopwatch;
  const Eigen::Index inputs = dynamics_.input_dim();
  const Eigen::Index horizon = settings_.horizon;
  if (plan_) {
    solver_->shift({.inputs_per_stage = inputs, .horizon = horizon});
  } else {
    solver_->forget();
  }
  Eigen::MatrixXd slopes(inputs, horizon);
  OcpProblem problem{.cost = {},
                     .lower = settings_.bounds.lower.replicate(horizon, 1),
                     .upper = settings_.bounds.upper.replicate(horizon, 1),
                     .constraints = {}};
  for (int round = 0; round < kAssignmentRounds; ++round) {
    HorizonCost cost(terms(predicted_noise_, plan.belief), plan.prediction, plan.policy);
    problem.cost = [&](const Eigen::VectorXd& z, Eigen::VectorXd& gradient) {
      const double value =
          cost.evaluate(Eigen::Map<const Eigen::MatrixXd>(z.data(), inputs, horizon), slopes);
      gradient = slopes.reshaped();
      return value;
    };
    const SolverResult& result =
        solver_->minimise(problem, plan.policy.inputs.reshaped(),
                          {.max_evaluations = settings_.max_evaluations - plan.evaluations});
    stopwatch.add_to(plan.timing.optimise);
    plan.evaluations += result.evaluations;
    plan.status = result.status;
    if (!std::isfinite(result.value)) {
      plan.cost.state = result.value;
      return;
    }
    // The candidate is priced with assignments and gains of its own, and kept only if it is better.
    Plan candidate;
    candidate.belief = plan.belief;
    candidate.policy = make_policy(belief.mean, result.z.reshaped(inputs, horizon));
    candidate.prediction = predict(dynamics_, *propagator_, plan.belief.measure, candidate.policy);
    candidate.cost = cost_of(candidate);
    stopwatch.add_to(plan.timing.propagate);
    const double gain = plan.cost.total() - candidate.cost.total();
    const double scale = std::abs(plan.cost.total());
    if (gain > 0.0 || !std::isfinite(plan.cost.total())) {
      plan.policy = std::move(candidate.policy);
      plan.prediction = std::move(candidate.prediction);
      plan.cost = candidate.cost;
    }
    if (gain < kSettled * scale || plan.evaluations >= settings_.max_evaluations) return;
  }
}

CostParts Planner::cost_of(const Plan& plan) const {
  HorizonCost cost(terms(predicted_noise_, plan.belief), plan.prediction, plan.policy);
  Eigen::MatrixXd gradient(plan.policy.inputs.rows(), plan.policy.inputs.cols());
  cost.evaluate(plan.policy.inputs, gradient);
  return cost.parts();
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

}  // namespace qsmpc
