// Sampled paths: states, costs, and the derivatives by the decision.
#include "controller/chance/sampled_paths.hpp"

#include <cmath>
#include <memory>

#include <gtest/gtest.h>

#include "models/random/random_numbers.hpp"
#include "tests/unit/controller/planning/planner_fixture.hpp"

namespace qsmpc::controller {
namespace sampled_paths_test {

using namespace testing;

constexpr Eigen::Index kPaths = 7;

Eigen::MatrixXd normals(Eigen::Index rows, Eigen::Index cols, std::uint64_t step) {
  return models::standard_normal_sample(rows * cols, {.seed = 4, .step = step})
      .reshaped(rows, cols);
}

PathDraw draw_of(const PlannerSettings& settings, double size) {
  PathDraw draw;
  draw.start = size * normals(3, kPaths, 0);
  for (int k = 0; k < settings.horizon; ++k) draw.noise.push_back(size * normals(3, kPaths, k + 1));
  return draw;
}

std::vector<Eigen::MatrixXd> some_gains(int horizon) {
  std::vector<Eigen::MatrixXd> gains;
  for (int k = 0; k < horizon; ++k) gains.push_back(0.5 * normals(1, 3, 100 + k));
  return gains;
}

/// The cost, and a function of the states of two stages, with its derivative.
double value_of(SampledPaths& paths, const QuadraticCost& cost, const Eigen::VectorXd& z,
                Eigen::VectorXd* gradient) {
  paths.rollout(z);
  paths.clear_adjoints();
  double value = paths.add_cost(cost).total();
  for (const Eigen::Index stage : {Eigen::Index{2}, paths.horizon()}) {
    const Points& states = paths.states(stage);
    value += states.row(0).array().sin().sum() + states.row(2).array().square().sum();
    paths.adjoint(stage).row(0).array() += states.row(0).array().cos();
    paths.adjoint(stage).row(2).array() += 2.0 * states.row(2).array();
  }
  if (gradient != nullptr) {
    gradient->setZero(z.size());
    paths.pull_back(*gradient);
  }
  return value;
}

void expect_gradient(SampledPaths& paths, const QuadraticCost& cost, const Eigen::VectorXd& z) {
  Eigen::VectorXd gradient;
  value_of(paths, cost, z, &gradient);
  constexpr double kStep = 1e-6;
  for (Eigen::Index i = 0; i < z.size(); ++i) {
    Eigen::VectorXd up = z;
    Eigen::VectorXd down = z;
    up[i] += kStep;
    down[i] -= kStep;
    const double slope =
        (value_of(paths, cost, up, nullptr) - value_of(paths, cost, down, nullptr)) / (2.0 * kStep);
    EXPECT_NEAR(gradient[i], slope, 1e-5 * (1.0 + std::abs(slope))) << "entry " << i;
  }
}

TEST(SampledPaths, derivatives_in_open_loop_with_feedback_and_with_answers_to_noise) {
  const auto car = dubins_car();
  const PlannerSettings settings = dubins_settings();
  // Enough noise to saturate some inputs under feedback.
  const PathDraw draw = draw_of(settings, 0.4);
  const std::vector<Eigen::MatrixXd> gains = some_gains(settings.horizon);
  const Eigen::VectorXd mean = Eigen::Vector3d(0.1, -0.2, 0.3);
  for (const Eigen::Index memory : {0, 2, 10}) {
    for (const bool feedback : {false, true}) {
      SCOPED_TRACE(::testing::Message() << "memory " << memory << ", feedback " << feedback);
      SampledPaths paths(*car, settings.bounds, settings.horizon, memory);
      paths.hold(mean, draw);
      const std::vector<Eigen::MatrixXd> held = feedback ? gains : std::vector<Eigen::MatrixXd>{};
      paths.hold_gains(held);
      Eigen::VectorXd z = 0.7 * normals(paths.decisions(), 1, 50);
      expect_gradient(paths, settings.cost, z);
    }
  }
}

TEST(SampledPaths, derivatives_of_the_noise_free_path_alone) {
  const auto car = dubins_car();
  const PlannerSettings settings = dubins_settings();
  const PathDraw none{.start = Points(3, 0), .noise = {}};
  SampledPaths paths(*car, settings.bounds, settings.horizon, 0);
  paths.hold(Eigen::Vector3d(0.1, -0.2, 0.3), none);
  expect_gradient(paths, settings.cost, 0.7 * normals(paths.decisions(), 1, 50));
}

TEST(SampledPaths, go_where_the_model_goes_step_by_step) {
  const auto car = dubins_car();
  const PlannerSettings settings = dubins_settings();
  const PathDraw draw = draw_of(settings, 0.1);
  const std::vector<Eigen::MatrixXd> gains = some_gains(settings.horizon);
  const Eigen::VectorXd mean = Eigen::Vector3d(0.1, -0.2, 0.3);
  SampledPaths paths(*car, settings.bounds, settings.horizon, 2);
  paths.hold(mean, draw);
  paths.hold_gains(gains);
  const Eigen::VectorXd z = 0.7 * normals(paths.decisions(), 1, 50);
  paths.rollout(z);

  const auto step = [&](const Eigen::VectorXd& state, double input) {
    models::StateBatch next(3, 1);
    car->step(models::StateBatch(state), models::StateBatch(Eigen::MatrixXd::Constant(1, 1, input)),
              next);
    return Eigen::VectorXd(next.col(0));
  };
  constexpr Eigen::Index kPath = 3;
  Eigen::VectorXd state = draw.start.col(kPath);
  Eigen::VectorXd nominal = mean;
  // After the inputs: no matrix for stage 0, one for stage 1, then two each, newest noise first.
  Eigen::Index matrix = settings.horizon;
  for (int k = 0; k < settings.horizon; ++k) {
    double input = z[k] + (gains[k] * (state - nominal))[0];
    for (int lag = 1; lag <= std::min(k, 2); ++lag, matrix += 3) {
      input += z.segment(matrix, 3).dot(Eigen::VectorXd(draw.noise[k - lag].col(kPath)));
    }
    input = std::clamp(input, settings.bounds.lower[0], settings.bounds.upper[0]);
    state = step(state, input) + Eigen::VectorXd(draw.noise[k].col(kPath));
    nominal = step(nominal, z[k]);
    EXPECT_LT((paths.states(k + 1).col(kPath) - state).norm(), 1e-12);
    EXPECT_LT((paths.states(k + 1).col(kPaths) - nominal).norm(), 1e-12);
  }
}

TEST(SampledPaths, a_decision_moves_on_by_a_stage) {
  const auto car = dubins_car();
  PlannerSettings settings = dubins_settings();
  settings.horizon = 4;
  const SampledPaths paths(*car, settings.bounds, 4, 2);
  // Inputs 0 … 3; matrices of stages 1, 2, 2, 3, 3 by lag.
  ASSERT_EQ(paths.decisions(), 4 + 5 * 3);
  Eigen::VectorXd z(paths.decisions());
  z.head<4>() << 0.0, 1.0, 2.0, 3.0;
  for (int block = 0; block < 5; ++block) z.segment<3>(4 + 3 * block).setConstant(10.0 + block);
  paths.shift(z);
  EXPECT_EQ(Eigen::Vector4d(z.head<4>()), Eigen::Vector4d(1.0, 2.0, 3.0, 3.0));
  // Stage 1 now has stage 2's matrix for the newest noise, and stage 2 has stage 3's matrices.
  const std::vector<double> expected{11.0, 13.0, 14.0, 13.0, 14.0};
  for (int block = 0; block < 5; ++block) EXPECT_EQ(z[4 + 3 * block], expected[block]);
}

}  // namespace sampled_paths_test
}  // namespace qsmpc::controller
