// The sampling controllers, compared with the regulator and the law that their weights represent.
#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include <Eigen/LU>
#include <gtest/gtest.h>

#include "controller/control/controller.hpp"
#include "controller/regions/unsafe_set.hpp"
#include "tests/support/executors.hpp"
#include "tests/unit/controller/planning/planner_fixture.hpp"

namespace qsmpc::controller {
namespace sampling_controller_test {

using namespace testing;

constexpr const char* kKinds[] = {"mppi", "risk_mppi"};

/// The double integrator about its origin, with bounds ten deviations of the perturbations away.
class LinearProblem {
 public:
  LinearProblem() {
    problem.horizon = 4;
    problem.noise_covariance = Eigen::Matrix2d::Zero();
    problem.cost = {.state = Eigen::Vector2d(2.0, 0.5).asDiagonal(),
                    .input = Eigen::MatrixXd::Constant(1, 1, 0.5),
                    .terminal = Eigen::Vector2d(3.0, 2.0).asDiagonal(),
                    .target = Eigen::Vector2d::Zero()};
    problem.safe_set = unbounded_safe_set(2);
    problem.bounds = {.lower = Eigen::VectorXd::Constant(1, -10.0),
                      .upper = Eigen::VectorXd::Constant(1, 10.0)};
    belief = {.mean = Eigen::Vector2d(0.6, -1.1), .covariance = Eigen::Matrix2d::Zero()};
    find_quadratic();
  }

  [[nodiscard]] Eigen::VectorXd minimum() const { return -hessian.inverse() * slope; }

  /// The inputs' covariance under perturbations of the given settings.
  [[nodiscard]] Eigen::MatrixXd perturbation(const MppiSettings& mppi) const {
    const double deviation = mppi.spread * 20.0;
    Eigen::MatrixXd covariance(problem.horizon, problem.horizon);
    for (int i = 0; i < problem.horizon; ++i) {
      for (int j = 0; j < problem.horizon; ++j) {
        covariance(i, j) = deviation * deviation *
                           std::pow(mppi.correlation, static_cast<double>(std::abs(i - j)));
      }
    }
    return covariance;
  }

  [[nodiscard]] double first_input(const MppiSettings& mppi, std::uint64_t seed) const {
    const auto controller = make_controller("mppi", *dynamics, {.problem = problem, .mppi = mppi});
    controller->reset(seed);
    return controller->decide({.belief = belief, .observation = belief.mean}).input[0];
  }

  std::unique_ptr<const models::Dynamics> dynamics =
      models::make_dynamics("double_integrator", {}, 0.5);
  PlannerSettings problem;
  Gaussian belief;
  Eigen::MatrixXd hessian;  ///< of the cost by the inputs
  Eigen::VectorXd slope;    ///< at inputs of 0

 private:
  [[nodiscard]] double cost_of(const Eigen::VectorXd& inputs) const {
    const Eigen::MatrixXd states = nominal_states(*dynamics, belief.mean, inputs.transpose());
    double cost = problem.cost.input(0, 0) * inputs.squaredNorm();
    for (Eigen::Index k = 0; k < inputs.size(); ++k) {
      cost += 0.5 * states.col(k).dot(problem.cost.state * states.col(k));
    }
    return cost +
           states.rightCols<1>().col(0).dot(problem.cost.terminal * states.rightCols<1>().col(0));
  }

  /// Exact up to rounding, as the cost is quadratic.
  void find_quadratic() {
    const int size = problem.horizon;
    const Eigen::MatrixXd unit = Eigen::MatrixXd::Identity(size, size);
    const double at_rest = cost_of(Eigen::VectorXd::Zero(size));
    hessian.resize(size, size);
    slope.resize(size);
    for (int i = 0; i < size; ++i) {
      slope[i] = 0.5 * (cost_of(unit.col(i)) - cost_of(-unit.col(i)));
      for (int j = 0; j < size; ++j) {
        hessian(i, j) = cost_of(unit.col(i) + unit.col(j)) - cost_of(unit.col(i)) -
                        cost_of(unit.col(j)) + at_rest;
      }
    }
  }
};

/// The law exp(−S/λ) N(0, Σ) of the inputs, whose mean the weights estimate with samples of
/// N(centre, Σ), and the standard deviation of the estimate.
class WeightedLaw {
 public:
  WeightedLaw(const LinearProblem& problem, const MppiSettings& mppi)
      : samples_(mppi.samples), base_(problem.perturbation(mppi).inverse()) {
    precision_ = problem.hessian / mppi.temperature + base_;
    mean_ = -precision_.inverse() * problem.slope / mppi.temperature;
  }

  [[nodiscard]] double first_mean() const { return mean_[0]; }

  /// Standard deviation of the self-normalised estimate of the first input's mean, to first order
  /// in 1/S:
  /// √(E_q[(p/q)² (v − μ)²] / S), with p the law and q = N(centre, Σ).
  [[nodiscard]] double first_deviation(const Eigen::VectorXd& centre) const {
    const Eigen::MatrixXd of_ratio = 2.0 * precision_ - base_;  // the precision of p²/q
    const Eigen::VectorXd middle = of_ratio.inverse() * (2.0 * precision_ * mean_ - base_ * centre);
    const double exponent = 0.5 * middle.dot(of_ratio * middle) - mean_.dot(precision_ * mean_) +
                            0.5 * centre.dot(base_ * centre);
    const double mass = precision_.determinant() /
                        std::sqrt(base_.determinant() * of_ratio.determinant()) *
                        std::exp(exponent);
    const double off = middle[0] - mean_[0];
    return std::sqrt(mass / samples_ * (of_ratio.inverse()(0, 0) + off * off));
  }

 private:
  double samples_;
  Eigen::MatrixXd base_;  // Σ⁻¹
  Eigen::MatrixXd precision_;
  Eigen::VectorXd mean_;
};

// The tolerance is the shift of the mean by the temperature plus five deviations of its estimate.
TEST(MppiController, tends_to_the_regulator_as_samples_grow_and_the_temperature_falls) {
  const LinearProblem linear;
  const auto regulator = make_controller("lqr", *linear.dynamics, {.problem = linear.problem});
  const double best =
      regulator->decide({.belief = linear.belief, .observation = linear.belief.mean}).input[0];
  ASSERT_NEAR(best, linear.minimum()[0], 1e-9);
  double last = 1e9;
  for (const auto& [samples, temperature] : {std::pair{2000, 2.0}, std::pair{200'000, 0.1}}) {
    const MppiSettings mppi{.samples = samples,
                            .temperature = temperature,
                            .spread = 0.05,
                            .correlation = 0.5,
                            .control_term = 0.0};
    const WeightedLaw law(linear, mppi);
    const double bias = std::abs(law.first_mean() - best);
    const double tolerance =
        bias + 5.0 * law.first_deviation(Eigen::VectorXd::Zero(linear.problem.horizon));
    EXPECT_LT(tolerance, 0.4 * last) << samples;
    EXPECT_LT(tolerance, 0.5 * std::abs(best)) << samples;
    for (const std::uint64_t seed : {1, 2, 3}) {
      EXPECT_NEAR(linear.first_input(mppi, seed), best, tolerance) << samples;
    }
    last = tolerance;
  }
}

// With the control term, samples about any nominal inputs estimate the same law, about 0; without
// it, each iteration continues from the last one's mean, towards the regulator.
TEST(MppiController, the_control_term_makes_up_for_where_samples_are_drawn) {
  const LinearProblem linear;
  MppiSettings mppi{.samples = 100'000,
                    .iterations = 15,
                    .temperature = 2.0,
                    .spread = 0.05,
                    .correlation = 0.5,
                    .control_term = 1.0};
  const WeightedLaw law(linear, mppi);
  const double best = linear.minimum()[0];
  // The nominal inputs of the last iteration are about the law's mean.
  const double with_term = linear.first_input(mppi, 4);
  EXPECT_NEAR(with_term, law.first_mean(), 0.1 * std::abs(law.first_mean() - best));
  mppi.control_term = 0.0;
  const double without = linear.first_input(mppi, 4);
  EXPECT_LT(std::abs(without - best), 0.1 * std::abs(law.first_mean() - best));
}

/// A car that goes past a block, for four periods.
std::vector<Eigen::VectorXd> inputs_of(const std::string& kind, const ControllerSettings& settings,
                                       std::uint64_t seed) {
  const auto car = dubins_car();
  const auto controller = make_controller(kind, *car, settings);
  controller->reset(seed);
  std::vector<Eigen::VectorXd> inputs;
  Gaussian belief = dubins_belief();
  for (int k = 0; k < 4; ++k) {
    belief.mean[0] = 0.15 * k;
    inputs.push_back(
        controller->decide({.period = k, .belief = belief, .observation = belief.mean}).input);
  }
  return inputs;
}

TEST(SamplingControllers, decide_the_same_on_any_number_of_threads_and_by_the_seed) {
  for (const std::string kind : kKinds) {
    for (const bool noise : {false, true}) {
      ControllerSettings settings{.problem = block_settings()};
      settings.mppi = {
          .samples = 700, .iterations = 2, .smoothing = 2, .noise = noise, .noise_paths = 5};
      const auto in_turn = inputs_of(kind, settings, 8);
      EXPECT_NE(inputs_of(kind, settings, 9), in_turn);
      settings.problem.run = run_on_threads;
      EXPECT_EQ(inputs_of(kind, settings, 8), in_turn) << kind << noise;
    }
  }
}

TEST(SamplingControllers, keep_the_bounds_of_inputs_however_wide_they_draw) {
  ControllerSettings settings{.problem = block_settings()};
  settings.problem.bounds = {.lower = Eigen::VectorXd::Constant(1, 0.2),
                             .upper = Eigen::VectorXd::Constant(1, 0.9)};
  settings.mppi = {.samples = 64, .spread = 3.0, .smoothing = 3, .noise_paths = 2};
  const auto car = dubins_car();
  const Gaussian belief = dubins_belief();
  for (const std::string kind : kKinds) {
    const auto controller = make_controller(kind, *car, settings);
    for (int k = 0; k < 5; ++k) {
      const Decision& decision =
          controller->decide({.period = k, .belief = belief, .observation = belief.mean});
      EXPECT_GE(decision.policy->inputs.minCoeff(), 0.2);
      EXPECT_LE(decision.policy->inputs.maxCoeff(), 0.9);
      EXPECT_GE(decision.input[0], 0.2);
    }
  }
}

/// The smallest clearance along the plan for the first period, after all iterations.
double planned_clearance(const std::string& kind, const ControllerSettings& settings) {
  const auto car = dubins_car();
  Gaussian belief = dubins_belief();
  belief.covariance *= 0.01;
  const auto controller = make_controller(kind, *car, settings);
  controller->reset(2);
  const Decision& decision = controller->decide({.belief = belief, .observation = belief.mean});
  EXPECT_EQ(decision.status, SolverStatus::kIterationLimit);
  return clearances(decision.policy->states, UnsafeSet(settings.problem.safe_set)).minCoeff();
}

// Heading for the block: only a plan that accounts for the noise keeps the clearance it needs.
TEST(SamplingControllers, keep_clear_of_a_block_and_farther_off_where_they_know_the_noise) {
  ControllerSettings settings{.problem = block_settings()};
  Box& block = std::get<Box>(settings.problem.safe_set.obstacles.front().form);
  block.lower[0] = 1.2;
  block.upper[0] = 1.6;
  settings.problem.noise_covariance = Eigen::Vector3d(1e-3, 1e-3, 2e-5).asDiagonal();
  settings.mppi = {
      .samples = 2000, .iterations = 8, .proximity_cost = 0.0, .noise_paths = 24, .cvar = 0.8};
  const double plain = planned_clearance("mppi", settings);
  const double aware = planned_clearance("risk_mppi", settings);
  EXPECT_GT(plain, 0.0);
  EXPECT_GT(aware, plain + 0.05);
  // The collision cost is what keeps them clear.
  settings.mppi.obstacle_cost = 0.0;
  EXPECT_LT(planned_clearance("mppi", settings), 0.0);
}

TEST(SamplingControllers, take_the_samples_that_are_done_by_the_deadline) {
  const auto car = dubins_car();
  const Gaussian belief = dubins_belief();
  ControllerSettings settings{.problem = block_settings()};
  settings.mppi = {.samples = 1000, .iterations = 1'000'000, .noise_paths = 3};
  for (const std::string kind : kKinds) {
    const auto controller = make_controller(kind, *car, settings);
    const Decision& decision = controller->decide(
        {.belief = belief,
         .observation = belief.mean,
         .deadline = std::chrono::steady_clock::now() + std::chrono::milliseconds(30)});
    EXPECT_EQ(decision.status, SolverStatus::kDeadline);
    EXPECT_GT(decision.evaluations, 1);
    EXPECT_TRUE(decision.input.allFinite());
  }
}

TEST(SamplingControllers, refuse_settings_out_of_range) {
  const auto car = dubins_car();
  const ControllerSettings usual{.problem = block_settings()};
  const auto refused = [&](const auto& change) {
    ControllerSettings settings = usual;
    change(settings.mppi);
    for (const std::string kind : kKinds) {
      EXPECT_THROW((void)make_controller(kind, *car, settings), std::invalid_argument);
    }
  };
  refused([](MppiSettings& mppi) { mppi.samples = 1; });
  refused([](MppiSettings& mppi) { mppi.iterations = 0; });
  refused([](MppiSettings& mppi) { mppi.temperature = -1.0; });
  refused([](MppiSettings& mppi) { mppi.effective_share = 0.0; });
  refused([](MppiSettings& mppi) { mppi.spread = 0.0; });
  refused([](MppiSettings& mppi) { mppi.correlation = 1.0; });
  refused([](MppiSettings& mppi) { mppi.control_term = 1.5; });
  refused([](MppiSettings& mppi) { mppi.smoothing = 1; });
  refused([](MppiSettings& mppi) { mppi.obstacle_cost = -1.0; });
  refused([](MppiSettings& mppi) { mppi.proximity_cost = -1.0; });
  refused([](MppiSettings& mppi) { mppi.margin = 0.0; });
  refused([](MppiSettings& mppi) { mppi.noise_paths = 0; });
  refused([](MppiSettings& mppi) { mppi.cvar = 1.0; });
}

}  // namespace sampling_controller_test
}  // namespace qsmpc::controller
