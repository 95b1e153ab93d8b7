#include "tests/support/policy_search.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>
#include <utility>

#include "models/linear_algebra.hpp"
#include "tests/support/slsqp_search.hpp"

namespace qsmpc::testing {
namespace {

// Relative price difference below which two descents count as having reached the same minimum.
constexpr double kSameMinimum = 5e-4;

/// Draws of N(0, covariance), positive definite, one per column.
models::StateBatch normal_draws(const Eigen::MatrixXd& covariance, int count,
                                std::mt19937_64& generator) {
  std::normal_distribution<double> normal;
  const models::StateBatch standard =
      models::StateBatch::NullaryExpr(covariance.rows(), count, [&] { return normal(generator); });
  return models::cholesky_factor(covariance) * standard;
}

/// h(s) of docs/theory/planning.md, and its slope.
double hinge(double distance, double length, double& slope) {
  const double share = 1.0 - distance / length;
  slope = share <= 0.0 ? 0.0 : -std::min(share, 1.0) / length;
  if (share <= 0.0) return 0.0;
  return share <= 1.0 ? 0.5 * share * share : share - 0.5;
}

/// The signed distance of `state` to the box: negative inside, by the depth. `normal` receives its
/// gradient.
double signed_distance(const Eigen::VectorXd& state, const controller::Box& box,
                       Eigen::VectorXd& normal) {
  normal = (state - box.upper).cwiseMax(0.0) - (box.lower - state).cwiseMax(0.0);
  const double distance = normal.norm();
  if (distance > 0.0) {
    normal /= distance;
    return distance;
  }
  Eigen::Index below = 0;
  Eigen::Index above = 0;
  const double depth_below = (state - box.lower).minCoeff(&below);
  const double depth_above = (box.upper - state).minCoeff(&above);
  normal[depth_below < depth_above ? below : above] = depth_below < depth_above ? -1.0 : 1.0;
  return -std::min(depth_below, depth_above);
}

/// Σ over the columns of (x − r)ᵀW(x − r).
double squares(const models::StateBatch& points, const Eigen::MatrixXd& weight,
               const Eigen::VectorXd& centre) {
  const models::StateBatch offset = points.colwise() - centre;
  return offset.cwiseProduct(weight * offset).sum();
}

/// Evaluates points and keeps the best, which need not be the last one of a search.
struct Descent {
  SampledProblem& problem;
  Eigen::MatrixXd best;
  double least = std::numeric_limits<double>::infinity();

  double evaluate(const std::vector<double>& inputs, std::vector<double>& gradient) {
    const Eigen::MatrixXd point =
        Eigen::Map<const Eigen::MatrixXd>(inputs.data(), best.rows(), best.cols());
    Eigen::MatrixXd slope(point.rows(), point.cols());
    const double value = problem.evaluate(point, slope);
    if (!gradient.empty()) std::copy(slope.data(), slope.data() + slope.size(), gradient.begin());
    if (value < least) {
      least = value;
      best = point;
    }
    return value;
  }
};

/// Each input in turn, constant in each half of the horizon with the others at mid-range; and
/// random ones.
std::vector<Eigen::MatrixXd> search_starts(const controller::PlannerSettings& settings,
                                           const SearchSettings& search) {
  constexpr std::array<double, 3> kShares = {-0.9, 0.0, 0.9};
  const Eigen::VectorXd middle = 0.5 * (settings.bounds.lower + settings.bounds.upper);
  const Eigen::VectorXd half = 0.5 * (settings.bounds.upper - settings.bounds.lower);
  const Eigen::MatrixXd centre = middle.replicate(1, settings.horizon);
  const int early = (settings.horizon + 1) / 2;
  std::vector<Eigen::MatrixXd> starts;
  for (Eigen::Index input = 0; input < middle.size(); ++input) {
    for (const double first : kShares) {
      for (const double second : kShares) {
        starts.push_back(centre);
        auto row = starts.back().row(input).array();
        row.head(early) += first * half[input];
        row.tail(settings.horizon - early) += second * half[input];
      }
    }
  }
  std::mt19937_64 generator(search.seed);
  std::uniform_real_distribution<double> share(-1.0, 1.0);
  for (int i = 0; i < search.random_starts; ++i) {
    const Eigen::MatrixXd shares = Eigen::MatrixXd::NullaryExpr(middle.size(), settings.horizon,
                                                                [&] { return share(generator); });
    starts.emplace_back(centre + half.asDiagonal() * shares);
  }
  return starts;
}

}  // namespace

SampledProblem::SampledProblem(const models::Dynamics& dynamics,
                               const controller::PlannerSettings& settings,
                               const controller::Gaussian& belief, Draws draws)
    : dynamics_(dynamics), settings_(settings), start_(belief.mean) {
  if (settings.penalty.shape != controller::PenaltyShape::kSmooth) {
    throw std::invalid_argument("sampled problem: only the smooth penalty is known");
  }
  std::mt19937_64 generator(draws.seed);
  const int dim = dynamics.state_dim();
  states_.resize(settings.horizon + 1, models::StateBatch(dim, draws.paths));
  states_[0] = normal_draws(belief.covariance, draws.paths, generator).colwise() + belief.mean;
  penalty_slopes_.resize(settings.horizon + 1, models::StateBatch::Zero(dim, draws.paths));
  inputs_.resize(settings.horizon, models::StateBatch(dynamics.input_dim(), draws.paths));
  gain_gradients_.resize(settings.horizon);
  for (int k = 0; k < settings.horizon; ++k) {
    noise_.push_back(normal_draws(settings.noise_covariance, draws.paths, generator));
  }
}

std::vector<Eigen::MatrixXd> SampledProblem::gains(const Eigen::MatrixXd& states,
                                                   const Eigen::MatrixXd& inputs) const {
  if (!settings_.closed_loop) {
    return std::vector<Eigen::MatrixXd>(settings_.horizon,
                                        Eigen::MatrixXd::Zero(inputs.rows(), states.rows()));
  }
  if (settings_.feedback_gain) {
    return std::vector<Eigen::MatrixXd>(settings_.horizon, *settings_.feedback_gain);
  }
  return controller::lqr_gains(dynamics_, states, inputs,
                               {.state = settings_.cost.state,
                                .input = 2.0 * settings_.cost.input,
                                .terminal = 2.0 * settings_.cost.terminal});
}

controller::Policy SampledProblem::policy_of(const Eigen::MatrixXd& inputs) const {
  controller::Policy policy{.inputs = inputs,
                            .states = controller::nominal_states(dynamics_, start_, inputs),
                            .gains = {},
                            .bounds = settings_.bounds};
  policy.gains = gains(policy.states, inputs);
  return policy;
}

double SampledProblem::evaluate(const controller::Policy& policy) {
  forward(policy);
  return value_;
}

double SampledProblem::evaluate(const Eigen::MatrixXd& inputs) {
  return evaluate(policy_of(inputs));
}

double SampledProblem::evaluate(const Eigen::MatrixXd& inputs, Eigen::MatrixXd& gradient) {
  const controller::Policy policy = policy_of(inputs);
  forward(policy);
  backward(policy, gradient);
  if (settings_.closed_loop && !settings_.feedback_gain) add_gain_gradient(inputs, gradient);
  return value_;
}

void SampledProblem::forward(const controller::Policy& policy) {
  const controller::QuadraticCost& cost = settings_.cost;
  double sum = 0.0;
  for (Eigen::Index k = 0; k < policy.horizon(); ++k) {
    models::StateBatch& inputs = inputs_[k];
    inputs = (policy.gains[k] * (states_[k].colwise() - policy.states.col(k))).colwise() +
             policy.inputs.col(k);
    inputs = inputs.cwiseMax(policy.bounds.lower.replicate(1, inputs.cols()))
                 .cwiseMin(policy.bounds.upper.replicate(1, inputs.cols()));
    sum += 0.5 * squares(states_[k], cost.state, cost.target) +
           squares(inputs, cost.input, Eigen::VectorXd::Zero(inputs.rows()));
    dynamics_.step(states_[k], inputs, states_[k + 1]);
    states_[k + 1] += noise_[k];
    sum += penalty(states_[k + 1], penalty_slopes_[k + 1]);
  }
  sum += squares(states_.back(), cost.terminal, cost.target);
  value_ = sum / static_cast<double>(states_[0].cols());
}

double SampledProblem::penalty(const models::StateBatch& states, models::StateBatch& slope) const {
  const controller::Penalty& penalty = settings_.penalty;
  const controller::Box& bounds = settings_.safe_set.bounds;
  double sum = 0.0;
  slope.setZero();
  Eigen::VectorXd state(states.rows());
  Eigen::VectorXd normal(states.rows());
  for (Eigen::Index i = 0; i < states.cols(); ++i) {
    state = states.col(i);
    for (Eigen::Index axis = 0; axis < state.size(); ++axis) {
      double low = 0.0;
      double high = 0.0;
      sum += penalty.box * (hinge(state[axis] - bounds.lower[axis], penalty.length, low) +
                            hinge(bounds.upper[axis] - state[axis], penalty.length, high));
      slope(axis, i) += penalty.box * (low - high);
    }
    for (const controller::Obstacle& each : settings_.safe_set.obstacles) {
      const controller::Box& obstacle = *each.box();
      double steepness = 0.0;
      sum += penalty.obstacle *
             hinge(signed_distance(state, obstacle, normal), penalty.length, steepness);
      slope.col(i) += penalty.obstacle * steepness * normal;
    }
  }
  return sum;
}

void SampledProblem::add_state_adjoint(Eigen::Index stage, const Eigen::MatrixXd& weight,
                                       models::StateBatch& adjoint) {
  const models::StateBatch offset = states_[stage].colwise() - settings_.cost.target;
  adjoint += weight * offset + penalty_slopes_[stage];
}

void SampledProblem::backward(const controller::Policy& policy, Eigen::MatrixXd& gradient) {
  const controller::QuadraticCost& cost = settings_.cost;
  const auto count = static_cast<double>(states_[0].cols());
  models::StateBatch adjoint = models::StateBatch::Zero(states_[0].rows(), states_[0].cols());
  models::StateBatch earlier = adjoint;
  models::StateBatch input_adjoint(policy.inputs.rows(), adjoint.cols());
  models::StateBatch nominal = models::StateBatch::Zero(adjoint.rows(), 1);
  models::StateBatch nominal_earlier = nominal;
  models::StateBatch nominal_input(policy.inputs.rows(), 1);
  add_state_adjoint(policy.horizon(), 2.0 * cost.terminal, adjoint);
  for (Eigen::Index k = policy.horizon() - 1; k >= 0; --k) {
    const Eigen::MatrixXd& gain = policy.gains[k];
    dynamics_.pullback(states_[k], inputs_[k], adjoint, earlier, input_adjoint);
    input_adjoint += 2.0 * cost.input * inputs_[k];
    for (Eigen::Index input = 0; input < gain.rows(); ++input) {
      const auto value = inputs_[k].row(input).array();
      if (gain.row(input).isZero(0.0)) continue;
      input_adjoint.row(input) =
          (value > policy.bounds.lower[input] && value < policy.bounds.upper[input])
              .select(input_adjoint.row(input).array(), 0.0);
    }
    adjoint = earlier + gain.transpose() * input_adjoint;
    add_state_adjoint(k, cost.state, adjoint);
    gain_gradients_[k] =
        input_adjoint * (states_[k].colwise() - policy.states.col(k)).transpose() / count;
    // The nominal path: x̄_{k+1} = f(x̄_k, v_k), and the inputs, which depend on v_k − K_k x̄_k.
    const models::StateBatch nominal_state = policy.states.col(k);
    const models::StateBatch nominal_value = policy.inputs.col(k);
    dynamics_.pullback(nominal_state, nominal_value, nominal, nominal_earlier, nominal_input);
    const Eigen::VectorXd sum = input_adjoint.rowwise().sum();
    nominal = nominal_earlier - gain.transpose() * sum;
    gradient.col(k) = (nominal_input + sum) / count;
  }
}

void SampledProblem::add_gain_gradient(const Eigen::MatrixXd& inputs,
                                       Eigen::MatrixXd& gradient) const {
  constexpr double kStep = 1e-5;  // of an input; the gains are smooth in it
  Eigen::MatrixXd moved = inputs;
  for (Eigen::Index i = 0; i < inputs.size(); ++i) {
    moved.data()[i] = inputs.data()[i] + kStep;
    const auto above = gains(controller::nominal_states(dynamics_, start_, moved), moved);
    moved.data()[i] = inputs.data()[i] - kStep;
    const auto below = gains(controller::nominal_states(dynamics_, start_, moved), moved);
    moved.data()[i] = inputs.data()[i];
    for (std::size_t k = 0; k < above.size(); ++k) {
      gradient.data()[i] +=
          gain_gradients_[k].cwiseProduct(above[k] - below[k]).sum() / (2.0 * kStep);
    }
  }
}

Eigen::MatrixXd SampledProblem::descend(const Eigen::MatrixXd& start) {
  constexpr double kTolerance = 1e-8;  // relative, of the price
  constexpr int kEvaluations = 100;    // of one run
  constexpr int kRuns = 6;             // each from the best point, without the curvature of the
                                       // previous run
  const Eigen::MatrixXd lower = settings_.bounds.lower.replicate(1, start.cols());
  const Eigen::MatrixXd upper = settings_.bounds.upper.replicate(1, start.cols());
  const auto as_vector = [](const Eigen::MatrixXd& matrix) {
    return std::vector<double>(matrix.data(), matrix.data() + matrix.size());
  };
  Descent descent{.problem = *this, .best = start};
  const SlsqpSearch settings{
      .cost = [&descent](
                  const std::vector<double>& inputs,
                  std::vector<double>& gradient) { return descent.evaluate(inputs, gradient); },
      .lower = as_vector(lower),
      .upper = as_vector(upper),
      .relative_tolerance = kTolerance,
      .evaluations = kEvaluations};
  for (int run = 0; run < kRuns; ++run) {
    const double before = descent.least;
    // A run may stop at a kink of the clamp or of a penalty; the next one restarts from there.
    (void)run_slsqp(settings, as_vector(descent.best));
    if (before - descent.least <= kTolerance * descent.least) break;
  }
  return descent.best;
}

std::vector<Eigen::MatrixXd> deepest_inputs(const models::Dynamics& dynamics,
                                            const controller::PlannerSettings& settings,
                                            const controller::Gaussian& belief,
                                            const SearchSettings& search,
                                            const std::vector<Eigen::MatrixXd>& also) {
  SampledProblem coarse(dynamics, settings, belief,
                        {.paths = search.coarse_paths, .seed = search.draws.seed});
  SampledProblem fine(dynamics, settings, belief, search.draws);
  std::vector<std::pair<double, Eigen::MatrixXd>> valleys;
  for (const Eigen::MatrixXd& start : search_starts(settings, search)) {
    const Eigen::MatrixXd found = coarse.descend(start);
    valleys.emplace_back(fine.evaluate(found), found);
  }
  std::sort(valleys.begin(), valleys.end(),
            [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<Eigen::MatrixXd> starts = also;
  double last = 0.0;
  for (const auto& [price, inputs] : valleys) {
    if (price - last <= kSameMinimum * price) continue;
    if (starts.size() == also.size() + search.kept) break;
    last = price;
    starts.push_back(inputs);
  }
  std::vector<Eigen::MatrixXd> result;
  for (const Eigen::MatrixXd& start : starts) result.push_back(fine.descend(start));
  return result;
}

}  // namespace qsmpc::testing
