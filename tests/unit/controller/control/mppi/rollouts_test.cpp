// Costs of rollouts, compared with one path at a time.
#include "controller/control/mppi/rollouts.hpp"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "models/constants.hpp"
#include "tests/unit/controller/planning/planner_fixture.hpp"

namespace qsmpc::controller {
namespace rollouts_test {

using namespace testing;

constexpr Eigen::Index kSamples = 21;  // not a multiple of any vector width

/// The car with a body of two discs, before a block, with a non-diagonal cost.
PlannerSettings long_car() {
  PlannerSettings problem = block_settings();
  problem.horizon = 6;
  problem.cost.state(0, 1) = problem.cost.state(1, 0) = 1.5;
  problem.safe_set.body = {
      .discs = {{.radius = 0.1, .offset = {0.2, 0.05}}, {.radius = 0.15, .offset = {-0.1, 0.0}}},
      .x = 0,
      .y = 1,
      .heading = 2};
  return problem;
}

SampleChunk random_chunk(const models::Dynamics& dynamics, int horizon, unsigned seed) {
  SampleChunk chunk(0, kSamples, dynamics.state_dim(), dynamics.input_dim(), horizon);
  std::mt19937_64 generator(seed);
  std::uniform_real_distribution<double> input(-2.0, 2.0);
  for (double& value : chunk.inputs.reshaped()) value = input(generator);
  return chunk;
}

/// The cost at one clearance.
double unsafe_at(const UnsafeCost& cost, double clearance) {
  const double ratio = clearance / cost.margin;
  if (ratio >= 1.0) return 0.0;
  const double hinge = ratio > 0.0 ? 0.5 * (1.0 - ratio) * (1.0 - ratio) : 0.5 - ratio;
  return (clearance <= 0.0 ? cost.collision : 0.0) + cost.proximity * hinge;
}

struct ExpectedCost {
  double quadratic = 0.0;
  double unsafe = 0.0;
};

/// The cost of one sample that starts at the first column of `path`; the other columns are added
/// after each step.
ExpectedCost expected_cost(const models::Dynamics& dynamics, const PlannerSettings& problem,
                           const UnsafeCost& cost, const Eigen::MatrixXd& inputs,
                           const Eigen::MatrixXd& path) {
  const UnsafeSet unsafe(problem.safe_set);
  ExpectedCost expected;
  models::StateBatch state = path.col(0);
  models::StateBatch next = state;
  for (Eigen::Index k = 0; k < inputs.cols(); ++k) {
    dynamics.step(state, models::StateBatch(inputs.col(k)), next);
    state = next + path.col(k + 1);
    const Eigen::VectorXd away = state.col(0) - problem.cost.target;
    expected.quadratic += k + 1 == inputs.cols() ? away.dot(problem.cost.terminal * away)
                                                 : 0.5 * away.dot(problem.cost.state * away);
    expected.unsafe += unsafe_at(cost, clearance(state.col(0), unsafe, k + 1));
  }
  return expected;
}

Eigen::MatrixXd inputs_of(const SampleChunk& chunk, Eigen::Index sample, Eigen::Index input_dim) {
  return chunk.inputs.col(sample).reshaped(input_dim, chunk.inputs.rows() / input_dim);
}

/// `path` with `start` added to its first column.
Eigen::MatrixXd path_from(const Eigen::VectorXd& start, Eigen::MatrixXd path) {
  path.col(0) += start;
  return path;
}

TEST(Rollouts, cost_the_quadratic_cost_and_the_unsafe_cost_of_every_stage) {
  const auto car = dubins_car();
  const PlannerSettings problem = long_car();
  const UnsafeCost cost{.collision = 70.0, .proximity = 11.0, .margin = 0.4};
  Rollouts rollouts(*car, problem, cost);
  const Eigen::Vector3d start(0.0, 0.36, 0.15);  // past the block or into it
  rollouts.place(start, problem.cost);
  SampleChunk chunk = random_chunk(*car, problem.horizon, 5);
  Eigen::MatrixXd path = Eigen::MatrixXd::Zero(3, problem.horizon + 1);
  for (const bool noisy : {false, true}) {
    if (noisy) path = 0.1 * Eigen::MatrixXd::Random(3, problem.horizon + 1);
    rollouts.roll_out({.path = noisy ? &path : nullptr}, chunk);
    int unsafe = 0;
    for (Eigen::Index i = 0; i < kSamples; ++i) {
      const ExpectedCost expected =
          expected_cost(*car, problem, cost, inputs_of(chunk, i, 1), path_from(start, path));
      // Different sine implementations, and sums in a different order.
      EXPECT_NEAR(chunk.quadratic[i], expected.quadratic, 1e-10 * expected.quadratic);
      EXPECT_NEAR(chunk.unsafe[i], expected.unsafe, 1e-9 * (1.0 + expected.unsafe));
      if (expected.unsafe > cost.collision) ++unsafe;
    }
    EXPECT_GT(unsafe, 0);
    EXPECT_LT(unsafe, kSamples);
  }
  Eigen::ArrayXd inputs = Eigen::ArrayXd::Zero(kSamples);
  rollouts.add_input_cost(chunk, inputs);
  EXPECT_NEAR(inputs[3], 0.1 * chunk.inputs.col(3).squaredNorm(), 1e-12 * inputs[3]);
}

// Means and covariances of the noise, within five standard errors.
TEST(NoisePaths, have_the_belief_and_the_noise) {
  constexpr int kPaths = 20000;
  constexpr int kHorizon = 2;
  Eigen::Matrix2d belief;
  belief << 0.5, 0.3, 0.3, 0.4;
  Eigen::Matrix2d step;
  step << 1.0, -0.6, -0.6, 2.0;
  CovarianceRoot belief_root;
  CovarianceRoot step_root;
  NoisePaths paths(kPaths, kHorizon, 2);
  const NoiseDraw draw{
      .start_root = belief_root.of(belief), .step_root = step_root.of(step), .seed = 9, .draw = 3};
  paths.draw(draw);
  for (int stage = 0; stage <= kHorizon; ++stage) {
    Eigen::MatrixXd columns(2, kPaths);
    for (int n = 0; n < kPaths; ++n) columns.col(n) = paths.path(n).col(stage);
    Points own = Points::Zero(2, kPaths);
    Points scratch(2, kPaths);
    add_own_noise(draw, kHorizon, stage, 0, own, scratch);
    const Eigen::Matrix2d expected = stage == 0 ? belief : step;
    for (const Eigen::MatrixXd& drawn : {columns, Eigen::MatrixXd(own)}) {
      const Eigen::MatrixXd covariance = drawn * drawn.transpose() / kPaths;
      const double deviation = 5.0 * std::sqrt(2.0 / kPaths) * expected.norm();
      EXPECT_LE((covariance - expected).cwiseAbs().maxCoeff(), deviation);
      EXPECT_LE(drawn.rowwise().mean().norm(), 5.0 * std::sqrt(expected.trace() / kPaths));
    }
  }
  const Eigen::MatrixXd before = paths.path(0);
  paths.draw(draw);
  EXPECT_EQ(paths.path(0), before);
  EXPECT_NE(paths.path(1), before);
}

}  // namespace rollouts_test
}  // namespace qsmpc::controller
