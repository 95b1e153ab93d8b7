// The expected cost's gradient, compared with differences at frozen assignments, and its value,
// compared with the closed form.
#include "controller/planning/cost/horizon_cost.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "controller/parallel.hpp"
#include "tests/unit/controller/measure/random_measures.hpp"
#include "tests/unit/controller/planning/planner_fixture.hpp"

namespace qsmpc::controller {
namespace horizon_cost_test {

using namespace testing;

// Central differences with h = 1e-6: rounding is ε·cost/h ≈ 2e-10 of the cost, truncation smaller,
// h².
constexpr double kDifferenceStep = 1e-6;
constexpr double kRelativeTolerance = 1e-6;
// An input moves by at most a few h, including through x̄: no clamp switches within a difference if
// no particle's unclamped input is this close to a bound.
constexpr double kClampMargin = 1e-4;

struct Case {
  int horizon;
  bool closed_loop;
  bool tight_bounds;  // so tight that most particles saturate
  std::string propagator;
  bool moving_target = false;  // differs between stages
};

class GradientCase {
 public:
  GradientCase(const Case& options, Generator& generator) : car_(dubins_car()) {
    settings_ = dubins_settings();
    settings_.cost = {.state = random_spd(generator, 3),
                      .input = random_spd(generator, 1),
                      .terminal = random_spd(generator, 3),
                      .target = random_matrix(generator, 3, 1)};
    if (options.moving_target) {
      settings_.cost.stage_targets = random_matrix(generator, 3, options.horizon + 1);
    }
    const double bound = options.tight_bounds ? 0.4 : 50.0;
    settings_.bounds = {.lower = Eigen::VectorXd::Constant(1, -bound),
                        .upper = Eigen::VectorXd::Constant(1, 0.8 * bound)};
    settings_.safe_set.obstacles.push_back(
        Box{.lower = Eigen::Vector3d(0.2, -0.3, -1e9), .upper = Eigen::Vector3d(0.5, 0.1, 1e9)});
    settings_.safe_set.bounds.lower[0] = -0.1;
    const Gaussian belief{.mean = random_matrix(generator, 3, 1, 0.2),
                          .covariance = random_spd(generator, 3, 0.02)};
    belief_ = quantise(belief, settings_.state_points);
    policy_.inputs = random_matrix(generator, 1, options.horizon, 0.3);
    policy_.states = nominal_states(*car_, belief.mean, policy_.inputs);
    policy_.bounds = settings_.bounds;
    for (int k = 0; k < options.horizon; ++k) {
      policy_.gains.emplace_back(options.closed_loop ? random_matrix(generator, 1, 3, 3.0)
                                                     : Eigen::MatrixXd::Zero(1, 3));
    }
    propagator_ = make_propagator(
        options.propagator,
        {.noise = {.mean = Eigen::VectorXd::Zero(3), .covariance = settings_.noise_covariance},
         .noise_points = settings_.noise_points,
         .compressed_points = settings_.compressed_points});
    prediction_ = predict(*car_, *propagator_, belief_.measure, policy_);
  }

  [[nodiscard]] const Eigen::MatrixXd& inputs() const { return policy_.inputs; }
  /// The target at every stage.
  void repeat_target() {
    settings_.cost.stage_targets = settings_.cost.target.replicate(1, policy_.horizon() + 1);
  }
  void move_target(Eigen::Index stage) { settings_.cost.stage_targets.col(stage).array() += 0.3; }
  [[nodiscard]] HorizonCost cost() const {
    return {{.dynamics = *car_,
             .safe_set = settings_.safe_set,
             .cost = settings_.cost,
             .penalty = settings_.penalty,
             .noise_covariance = settings_.noise_covariance,
             .within_covariance = belief_.within_covariance},
            prediction_,
            policy_};
  }

  /// Distance of the nearest unclamped input to a bound, and the number of inputs beyond one.
  struct Clamps {
    double nearest = 1e300;
    int saturated = 0;
    int free = 0;
  };
  [[nodiscard]] Clamps clamps() const {
    Clamps result;
    for (Eigen::Index k = 0; k < policy_.horizon(); ++k) {
      const Points& states = prediction_.stages[k].locations;
      for (Eigen::Index i = 0; i < states.cols(); ++i) {
        const double wanted =
            policy_.inputs(0, k) + (policy_.gains[k] * (states.col(i) - policy_.states.col(k)))(0);
        const double room =
            std::min(wanted - policy_.bounds.lower[0], policy_.bounds.upper[0] - wanted);
        result.nearest = std::min(result.nearest, std::abs(room));
        ++(room < 0.0 ? result.saturated : result.free);
      }
    }
    return result;
  }

 private:
  std::unique_ptr<const models::Dynamics> car_;
  PlannerSettings settings_;
  GaussianQuantisation belief_;
  Policy policy_;
  std::unique_ptr<Propagator> propagator_;
  Prediction prediction_;
};

class HorizonCostGradient : public ::testing::TestWithParam<Case> {};

TEST_P(HorizonCostGradient, equals_central_differences) {
  Generator generator(91);
  int checked = 0;
  int saturated = 0;
  for (int repetition = 0; repetition < 40 && checked < 8; ++repetition) {
    const GradientCase problem(GetParam(), generator);
    if (problem.clamps().nearest < kClampMargin) continue;
    HorizonCost cost = problem.cost();
    Eigen::MatrixXd gradient = Eigen::MatrixXd::Constant(1, problem.inputs().cols(), std::nan(""));
    Eigen::MatrixXd unused = gradient;
    const double value = cost.evaluate(problem.inputs(), gradient);
    for (Eigen::Index k = 0; k < gradient.cols(); ++k) {
      Eigen::MatrixXd high = problem.inputs();
      Eigen::MatrixXd low = problem.inputs();
      high(0, k) += kDifferenceStep;
      low(0, k) -= kDifferenceStep;
      const double slope =
          (cost.evaluate(high, unused) - cost.evaluate(low, unused)) / (2.0 * kDifferenceStep);
      EXPECT_NEAR(gradient(0, k), slope, kRelativeTolerance * (std::abs(slope) + std::abs(value)))
          << "stage " << k;
    }
    ++checked;
    saturated += problem.clamps().saturated;
  }
  EXPECT_GE(checked, 4);
  if (GetParam().closed_loop && GetParam().tight_bounds) {
    EXPECT_GT(saturated, 0);
  } else {
    EXPECT_EQ(saturated, 0);
  }
}

std::vector<Case> every_case() {
  std::vector<Case> cases;
  for (const int horizon : {1, 2, 8}) {
    for (const bool closed_loop : {false, true}) {
      for (const bool tight_bounds : {false, true}) {
        for (const PropagatorEntry& entry : propagators()) {
          cases.push_back({horizon, closed_loop, tight_bounds, entry.name});
        }
      }
    }
  }
  for (const bool closed_loop : {false, true}) {
    cases.push_back({8, closed_loop, false, "mixture", true});
  }
  return cases;
}

INSTANTIATE_TEST_SUITE_P(cases, HorizonCostGradient, ::testing::ValuesIn(every_case()),
                         [](const auto& information) {
                           const Case& options = information.param;
                           return std::string(options.closed_loop ? "closed" : "open") +
                                  (options.tight_bounds ? "_tight_" : "_wide_") +
                                  options.propagator + "_" + std::to_string(options.horizon) +
                                  (options.moving_target ? "_moving" : "");
                         });

TEST(HorizonCost, of_the_same_target_at_every_stage_is_that_of_one_target) {
  Generator generator(17);
  GradientCase problem(
      {.horizon = 6, .closed_loop = true, .tight_bounds = false, .propagator = "mixture"},
      generator);
  Eigen::MatrixXd gradient(1, 6);
  Eigen::MatrixXd same(1, 6);
  const double value = problem.cost().evaluate(problem.inputs(), gradient);
  problem.repeat_target();
  EXPECT_EQ(problem.cost().evaluate(problem.inputs(), same), value);
  EXPECT_EQ(same, gradient);
}

TEST(HorizonCost, of_each_stage_is_about_its_own_target) {
  Generator generator(19);
  GradientCase problem(
      {.horizon = 3, .closed_loop = false, .tight_bounds = false, .propagator = "mixture"},
      generator);
  Eigen::MatrixXd gradient(1, 3);
  problem.repeat_target();
  HorizonCost still = problem.cost();
  const double before = still.evaluate(problem.inputs(), gradient);
  const CostParts parts = still.parts();
  problem.move_target(3);  // the last one only enters the terminal cost
  HorizonCost moved = problem.cost();
  EXPECT_NE(moved.evaluate(problem.inputs(), gradient), before);
  EXPECT_EQ(moved.parts()[cost_part("state")], parts[cost_part("state")]);
  EXPECT_NE(moved.parts()[cost_part("terminal")], parts[cost_part("terminal")]);
}

/// E[(x − r)ᵀQ(x − r)] for x with this law.
double expected_square(const Gaussian& law, const Eigen::MatrixXd& matrix,
                       const Eigen::VectorXd& target) {
  const Eigen::VectorXd offset = law.mean - target;
  return offset.dot(matrix * offset) + matrix.cwiseProduct(law.covariance).sum();
}

/// Mean and covariance of the open-loop car after `stages` steps, from E e^{iφ} for normal φ.
Gaussian exact_moments(const Gaussian& belief, const Eigen::VectorXd& inputs,
                       const Eigen::MatrixXd& noise, int stages) {
  constexpr double kReach = 0.15;
  constexpr double kTimeStep = 0.1;
  Gaussian law = belief;
  std::vector<double> means;
  std::vector<double> variances;
  for (int k = 0; k < stages; ++k) {
    means.push_back(belief.mean[2] + kTimeStep * inputs.head(k).sum());
    variances.push_back(belief.covariance(2, 2) + k * noise(2, 2));
  }
  law.mean[2] += kTimeStep * inputs.head(stages).sum();
  law.covariance += stages * noise;
  for (int k = 0; k < stages; ++k) {
    const double shrink = std::exp(-0.5 * variances[k]);
    const Eigen::Vector2d mean = shrink * Eigen::Vector2d(std::cos(means[k]), std::sin(means[k]));
    law.mean.head<2>() += kReach * mean;
    for (int j = 0; j < stages; ++j) {
      // cos a cos b = ½ (cos(a − b) + cos(a + b)) and so on; Cov(φ_j, φ_k) is the smaller variance.
      const double covariance = std::min(variances[j], variances[k]);
      const double half = 0.5 * (variances[j] + variances[k]);
      const double with = std::exp(-half + covariance);
      const double against = std::exp(-half - covariance);
      const double difference = means[j] - means[k];
      const double sum = means[j] + means[k];
      Eigen::Matrix2d second;
      second(0, 0) = 0.5 * (with * std::cos(difference) + against * std::cos(sum));
      second(1, 1) = 0.5 * (with * std::cos(difference) - against * std::cos(sum));
      second(0, 1) = 0.5 * (against * std::sin(sum) - with * std::sin(difference));
      second(1, 0) = 0.5 * (against * std::sin(sum) + with * std::sin(difference));
      const Eigen::Vector2d other =
          std::exp(-0.5 * variances[j]) * Eigen::Vector2d(std::cos(means[j]), std::sin(means[j]));
      law.covariance.topLeftCorner<2, 2>() += kReach * kReach * (second - other * mean.transpose());
    }
  }
  return law;
}

struct Comparison {
  CostParts predicted;
  double exact = 0.0;
};

struct PointCounts {
  int state;
  int noise;
  int compressed;
};

/// Six open-loop stages from the usual belief. The cost does not depend on the heading, so only the
/// position's mean and covariance enter.
Comparison compare_open_loop(const Eigen::Vector3d& target, const PointCounts& points) {
  constexpr int kHorizon = 6;
  const auto car = dubins_car();
  const Gaussian belief = dubins_belief();
  PlannerSettings settings = dubins_settings();
  settings.safe_set = unbounded_safe_set(3);
  settings.cost.target = target;
  Policy policy{.inputs = Eigen::MatrixXd::Constant(1, kHorizon, 0.3),
                .states = {},
                .gains = std::vector<Eigen::MatrixXd>(kHorizon, Eigen::MatrixXd::Zero(1, 3)),
                .bounds = settings.bounds};
  policy.states = nominal_states(*car, belief.mean, policy.inputs);
  const auto propagator = make_propagator(
      "compressed",
      {.noise = {.mean = Eigen::VectorXd::Zero(3), .covariance = settings.noise_covariance},
       .noise_points = points.noise,
       .compressed_points = points.compressed});
  const GaussianQuantisation quantised = quantise(belief, points.state);
  const Prediction prediction = predict(*car, *propagator, quantised.measure, policy);
  HorizonCost cost({.dynamics = *car,
                    .safe_set = settings.safe_set,
                    .cost = settings.cost,
                    .penalty = settings.penalty,
                    .noise_covariance = settings.noise_covariance,
                    .within_covariance = quantised.within_covariance},
                   prediction, policy);
  Eigen::MatrixXd gradient(1, kHorizon);
  cost.evaluate(policy.inputs, gradient);
  const Eigen::VectorXd inputs = policy.inputs.row(0);
  Comparison result{.predicted = cost.parts()};
  for (int k = 0; k < kHorizon; ++k) {
    result.exact +=
        0.5 * expected_square(exact_moments(belief, inputs, settings.noise_covariance, k),
                              settings.cost.state, target);
  }
  result.exact +=
      expected_square(exact_moments(belief, inputs, settings.noise_covariance, kHorizon),
                      settings.cost.terminal, target);
  result.exact += settings.cost.input(0, 0) * inputs.squaredNorm();
  return result;
}

TEST(HorizonCost, open_loop_value_is_near_the_closed_form) {
  // More particles than a task takes, in the belief and at each stage.
  static_assert(kChunk < 1100);
  const Comparison comparison = compare_open_loop(
      Eigen::Vector3d(5.0, 5.0, 0.0), {.state = 1500, .noise = 100, .compressed = 1100});
  // The variance lost by the quantisers is a small part of the cost of being far away.
  EXPECT_NEAR(comparison.predicted.total(), comparison.exact, 0.005 * comparison.exact);
  EXPECT_NEAR(comparison.predicted.of("input"), 6 * 0.1 * 0.3 * 0.3, 1e-12);  // rounding
  EXPECT_EQ(comparison.predicted.of("box") + comparison.predicted.of("obstacle"), 0.0);
}

TEST(HorizonCost, shortfall_of_the_variance_shrinks_with_more_points) {
  // At the target the cost is all variance, part of which quantisers and compression lose.
  const Eigen::Vector3d target(0.5, 0.05, 0.0);
  const Comparison coarse = compare_open_loop(target, {.state = 50, .noise = 30, .compressed = 50});
  const Comparison fine =
      compare_open_loop(target, {.state = 1000, .noise = 200, .compressed = 500});
  EXPECT_LT(coarse.predicted.total(), coarse.exact);
  EXPECT_LT(fine.predicted.total(), fine.exact);
  EXPECT_LT(fine.exact - fine.predicted.total(), 0.5 * (coarse.exact - coarse.predicted.total()));
}

TEST(HorizonCost, one_step_from_a_belief_is_exact_but_for_the_belief_quantiser) {
  // Horizon 1, terminal state cost only: the noise enters exactly, through tr(PΣ).
  const auto car = dubins_car();
  Gaussian known = dubins_belief();
  known.covariance.setZero();
  PlannerSettings settings = dubins_settings();
  settings.safe_set = unbounded_safe_set(3);
  Policy policy{.inputs = Eigen::MatrixXd::Constant(1, 1, 0.3),
                .states = {},
                .gains = {Eigen::MatrixXd::Zero(1, 3)},
                .bounds = settings.bounds};
  policy.states = nominal_states(*car, known.mean, policy.inputs);
  const auto propagator = make_propagator(
      "compressed",
      {.noise = {.mean = Eigen::VectorXd::Zero(3), .covariance = settings.noise_covariance},
       .noise_points = 3,
       .compressed_points = 2});
  const GaussianQuantisation quantised = quantise(known, 1);
  const Prediction prediction = predict(*car, *propagator, quantised.measure, policy);
  HorizonCost cost({.dynamics = *car,
                    .safe_set = settings.safe_set,
                    .cost = settings.cost,
                    .penalty = settings.penalty,
                    .noise_covariance = settings.noise_covariance,
                    .within_covariance = quantised.within_covariance},
                   prediction, policy);
  Eigen::MatrixXd gradient(1, 1);
  cost.evaluate(policy.inputs, gradient);
  const Gaussian next{.mean = policy.states.col(1), .covariance = settings.noise_covariance};
  EXPECT_NEAR(cost.parts().of("terminal"),
              expected_square(next, settings.cost.terminal, settings.cost.target), 1e-11);
  EXPECT_NEAR(cost.parts().of("state"),
              0.5 * expected_square(known, settings.cost.state, settings.cost.target), 1e-11);
}

}  // namespace horizon_cost_test
}  // namespace qsmpc::controller
