#include "harness/mismatch/path_ensemble.hpp"

#include <cmath>
#include <memory>

#include <gtest/gtest.h>

#include "harness/assembly/assembly.hpp"
#include "harness/mismatch/horizon_comparison.hpp"
#include "harness/prediction/prediction_report.hpp"
#include "harness/threads/executor.hpp"
#include "tests/support/executors.hpp"
#include "tests/unit/mismatch/mismatch_fixture.hpp"

namespace qsmpc::harness {
namespace path_ensemble_test {

using testing::altered_plants;
using testing::Planned;
using testing::short_scenario;

constexpr std::int64_t kPaths = 130;  // not a multiple of a batch

/// A unit mass far from its input bounds.
Scenario mass_scenario(const std::string& policy) {
  return parse_scenario(
      "name: mass\nmodel: {system: double_integrator}\nplant: {kind: analytic}\n"
      "initial_state: {mean: [0, 0], covariance: [0.05, 0.05]}\n"
      "disturbance: {covariance: [0.001, 0.001]}\n"
      "safe_set: {bounds: {position: [-5, 5]}}\ntarget: {state: [2, 0], radius: 0.2}\n"
      "controller:\n  horizon: 4\n  input_bounds: {acceleration: [-1000, 1000]}\n"
      "  cost: {state: [30, 5], input: [20], terminal: [40, 10]}\n  policy: " +
      policy + "\n");
}

PlantPaths paths_of(PlantPool& pool, const Planned& planned,
                    const controller::Executor& run = controller::run_in_turn) {
  SharedWork work(path_batches(kPaths), {}, {});
  return plant_paths(pool, *planned.model, planned.source(), kPaths, run, work);
}

TEST(PlantPaths, of_the_model_itself_are_the_models_but_for_rounding) {
  const Planned planned(testing::short_scenario());
  PlantPool pool = testing::altered_plants(planned.scenario, Eigen::Vector3d::Zero());
  const PlantPaths plant = paths_of(pool, planned);
  const std::vector<controller::Points> model =
      model_paths(*planned.model, planned.source(), kPaths, controller::run_in_turn);
  ASSERT_EQ(plant.states.size(), 4U);
  for (std::size_t k = 0; k < 4; ++k) {
    EXPECT_LT((plant.states[k] - model[k]).cwiseAbs().maxCoeff(), 1e-14) << k;
  }
  for (const controller::Points& residuals : plant.residuals) {
    EXPECT_LT(residuals.cwiseAbs().maxCoeff(), 1e-14);
  }
}

TEST(PlantPaths, a_bias_of_the_plant_is_its_residual) {
  const Planned planned(testing::short_scenario());
  const Eigen::Vector3d bias(0.02, -0.01, 0.003);
  PlantPool pool = testing::altered_plants(planned.scenario, bias);
  for (const controller::Points& residuals : paths_of(pool, planned).residuals) {
    for (const auto& residual : residuals.colwise()) {
      EXPECT_LT((residual - bias).cwiseAbs().maxCoeff(), 1e-14);  // rounding of states of size 1
    }
  }
}

// A double integrator in open loop: additions to position and velocity persist, and the velocity's
// also changes the position, by the model's own equations.
TEST(PlantPaths, a_bias_adds_up_along_the_horizon_by_the_models_equations) {
  const Planned planned(mass_scenario("open_loop"));
  const Eigen::Vector2d bias(0.002, 0.03);
  PlantPool pool = testing::altered_plants(planned.scenario, bias);
  const PlantPaths plant = paths_of(pool, planned);
  const std::vector<controller::Points> model =
      model_paths(*planned.model, planned.source(), kPaths, controller::run_in_turn);
  const auto horizon =
      compare_along_horizon(plant, model, planned.particles, planned.scenario.safe_set,
                            {.w2_paths = kPaths}, controller::run_in_turn);
  Eigen::Vector2d expected = Eigen::Vector2d::Zero();
  for (const HorizonStage& stage : horizon) {
    expected[0] += planned.scenario.time_step * expected[1];
    expected += bias;
    EXPECT_TRUE(stage.divergence_rmse.isApprox(expected, 1e-10)) << stage.stage;
    EXPECT_TRUE(stage.residual_rmse.isApprox(bias, 1e-10));
  }
}

// In closed loop the difference e of plant and model obeys e⁺ = (A + B K) e + bias while no input
// is at its bounds, as each is fed back its own state.
TEST(PlantPaths, plant_and_model_are_each_fed_back_their_own_state) {
  const Planned planned(mass_scenario("closed_loop"));
  const Eigen::Vector2d bias(0.002, 0.03);
  PlantPool pool = testing::altered_plants(planned.scenario, bias);
  const PlantPaths plant = paths_of(pool, planned);
  const std::vector<controller::Points> model =
      model_paths(*planned.model, planned.source(), kPaths, controller::run_in_turn);
  Eigen::MatrixXd a(2, 2);
  Eigen::MatrixXd b(2, 1);
  Eigen::Vector2d expected = Eigen::Vector2d::Zero();
  for (std::size_t k = 0; k < planned.policy.gains.size(); ++k) {
    planned.model->jacobians(Eigen::Vector2d::Zero(), Eigen::VectorXd::Zero(1), a, b);
    ASSERT_GT(planned.policy.gains[k].norm(), 1e-3);
    expected = (a + b * planned.policy.gains[k]) * expected + bias;
    const controller::Points difference = plant.states[k + 1] - model[k + 1];
    for (const auto& column : difference.colwise()) {
      EXPECT_LT((column - expected).norm(), 1e-12) << k;
    }
  }
}

TEST(ModelPaths, are_those_that_a_prediction_simulates) {
  const Planned planned(testing::short_scenario({"safe_set.bounds.x=[-0.15, 6]"}));
  const std::vector<controller::Points> model =
      model_paths(*planned.model, planned.source(), kPaths, controller::run_in_turn);
  const PredictionReport report = predict_scenario(
      planned.scenario, {.monte_carlo = {.samples = kPaths, .should_stop = {}, .on_progress = {}}});
  std::int64_t events = 0;
  for (std::size_t k = 1; k < model.size(); ++k) {
    std::int64_t unsafe = 0;
    for (const auto& state : model[k].colwise()) {
      unsafe += controller::distance_to_unsafe(state, planned.scenario.safe_set) <= 0.0 ? 1 : 0;
    }
    EXPECT_EQ(unsafe, report.monte_carlo->stages[k - 1]) << k;
    events += unsafe;
  }
  EXPECT_GT(events, 0);
}

TEST(PlantPaths, are_the_same_bit_for_bit_in_any_order_and_on_any_number_of_threads) {
  const Planned planned(testing::short_scenario({"plant.kind=mujoco", "controller.horizon=2"}));
  PlantPool pool([&](std::int64_t) { return make_plant(planned.scenario); });
  const PlantPaths reference = paths_of(pool, planned);
  for (const controller::Executor& run :
       {controller::Executor(testing::run_backwards), controller::Executor(testing::run_on_threads),
        executor_of(2)}) {
    const PlantPaths paths = paths_of(pool, planned, run);
    for (std::size_t k = 0; k < reference.states.size(); ++k) {
      EXPECT_EQ(paths.states[k], reference.states[k]) << k;
    }
  }
  const std::vector<controller::Points> model =
      model_paths(*planned.model, planned.source(), kPaths, controller::run_in_turn);
  EXPECT_EQ(model_paths(*planned.model, planned.source(), kPaths, testing::run_on_threads), model);
}

TEST(PlantPaths, have_vehicles_of_their_own_where_these_differ) {
  const Planned planned(testing::short_scenario(
      {"plant.kind=mujoco", "controller.horizon=2", "disturbance.wheelbase=0.2"}));
  const auto make = [&](std::int64_t path) {
    return make_plant(planned.scenario, draw_variation(planned.scenario.disturbance, 1,
                                                       static_cast<std::uint64_t>(path)));
  };
  constexpr std::int64_t kFew = 45;
  const auto paths = [&](PlantPool pool, const controller::Executor& run) {
    SharedWork work(path_batches(kFew), {}, {});
    return plant_paths(pool, *planned.model, planned.source(), kFew, run, work).states.back();
  };
  const auto differing = [&] { return PlantPool(make, varies(planned.scenario.disturbance)); };
  const controller::Points reference = paths(differing(), controller::run_in_turn);
  EXPECT_EQ(paths(differing(), executor_of(2)), reference);
  EXPECT_EQ(paths(differing(), testing::run_backwards), reference);
  const controller::Points alike = paths(PlantPool(make), controller::run_in_turn);
  EXPECT_EQ(alike.col(0), reference.col(0));
  EXPECT_GT((alike - reference).rightCols(kFew - 1).cwiseAbs().colwise().maxCoeff().minCoeff(),
            0.0);
}

TEST(PlantPaths, a_path_depends_on_its_number_alone) {
  const Planned planned(testing::short_scenario());
  const std::vector<controller::Points> all =
      model_paths(*planned.model, planned.source(), kPaths, controller::run_in_turn);
  const std::vector<controller::Points> some =
      model_paths(*planned.model, planned.source(/*first=*/100), 30, controller::run_in_turn);
  EXPECT_EQ(some.back(), all.back().middleCols(100, 30));
}

TEST(PlantPaths, one_that_breaks_is_unsafe_from_then_on_and_in_no_average) {
  const Planned planned(testing::short_scenario());
  PlantPool pool =
      testing::altered_plants(planned.scenario, Eigen::Vector3d::Zero(), /*breaks_at=*/0.3);
  const PlantPaths plant = paths_of(pool, planned);
  const std::vector<controller::Points> model =
      model_paths(*planned.model, planned.source(), kPaths, controller::run_in_turn);
  const auto horizon =
      compare_along_horizon(plant, model, planned.particles, planned.scenario.safe_set,
                            {.w2_paths = kPaths}, controller::run_in_turn);
  EXPECT_GT(plant.faults, 0);
  EXPECT_LT(plant.faults, kPaths);
  EXPECT_GE(horizon.back().unsafe, plant.faults);
  EXPECT_LE(horizon.front().unsafe, horizon.back().unsafe);
  for (const HorizonStage& stage : horizon) {
    EXPECT_LT(stage.divergence_rmse.maxCoeff(), 1e-14);
    EXPECT_TRUE(std::isfinite(stage.w2));
  }
}

TEST(PlantPaths, a_drawn_vehicle_that_the_simulator_refuses_is_counted_and_ends_nothing) {
  const Planned planned(testing::short_scenario());
  const auto make = [&](std::int64_t path) {
    if (path % 10 == 0) throw SimulatorError({.found = "a vehicle that does not settle"});
    return make_plant(planned.scenario);
  };
  PlantPool drawn(make, /*differ=*/true);
  const PlantPaths paths = paths_of(drawn, planned);
  EXPECT_EQ(paths.faults, kPaths / 10);
  EXPECT_TRUE(std::isnan(paths.states.back()(0, 0)));
  EXPECT_TRUE(std::isfinite(paths.states.back()(0, 1)));
  // If all are alike, the file is wrong.
  EXPECT_THROW((void)PlantPool(make), SimulatorError);
}

TEST(PlantPaths, stop_when_asked) {
  const Planned planned(testing::short_scenario());
  PlantPool pool = testing::altered_plants(planned.scenario, Eigen::Vector3d::Zero());
  SharedWork work(path_batches(kPaths), [] { return true; }, {});
  const PlantPaths plant =
      plant_paths(pool, *planned.model, planned.source(), kPaths, controller::run_in_turn, work);
  EXPECT_TRUE(plant.states.front().hasNaN());
}

TEST(HorizonComparison, unsafe_paths_are_counted_with_their_limits) {
  const Planned planned(testing::short_scenario());
  PlantPaths plant;
  plant.states.assign(4, controller::Points::Zero(3, 10));
  plant.residuals.assign(3, controller::Points::Zero(3, 10));
  plant.states[2].row(1).head(4).setConstant(-0.7);  // beyond the wall at −0.6
  const auto horizon =
      compare_along_horizon(plant, plant.states, planned.particles, planned.scenario.safe_set,
                            {.w2_paths = 10}, controller::run_in_turn);
  EXPECT_EQ(horizon[0].unsafe, 0);
  EXPECT_EQ(horizon[1].unsafe, 4);
  const RateInterval limits = clopper_pearson(4, 10, 0.005);
  EXPECT_EQ(horizon[1].unsafe_limits.lower, limits.lower);
  EXPECT_EQ(horizon[1].unsafe_limits.upper, limits.upper);
}

TEST(W2Floors, of_independent_ensembles_spread_about_what_one_more_has) {
  const Planned planned(testing::short_scenario());
  const FloorSettings settings{.numbers = {.seed = 5}, .paths = kPaths, .count = kPaths};
  const auto floors =
      w2_floors(planned.particles, *planned.model, planned.policy, planned.belief,
                planned.scenario.disturbance.covariance, settings, controller::run_in_turn);
  PlantPool pool = testing::altered_plants(planned.scenario, Eigen::Vector3d::Zero());
  const auto horizon = compare_along_horizon(
      paths_of(pool, planned),
      model_paths(*planned.model, planned.source(), kPaths, controller::run_in_turn),
      planned.particles, planned.scenario.safe_set, {.w2_paths = kPaths}, controller::run_in_turn);
  // Student's t with seven degrees of freedom, widened for one more draw: 1 in 1000.
  const double limit = 5.41 * std::sqrt(1.0 + 1.0 / kFloorEnsembles);
  for (const HorizonStage& stage : horizon) {
    const W2Floor& floor = floors[static_cast<std::size_t>(stage.stage)];
    EXPECT_GT(floor.deviation, 0.0);
    EXPECT_LT(std::abs(stage.w2 - floor.mean), limit * floor.deviation) << stage.stage;
  }
}

TEST(W2Floors, take_other_random_numbers_than_the_paths_that_they_are_held_against) {
  const Planned planned(testing::short_scenario());
  const auto floors = [&](std::uint64_t first, std::int64_t paths) {
    return w2_floors(planned.particles, *planned.model, planned.policy, planned.belief,
                     planned.scenario.disturbance.covariance,
                     {.numbers = {.seed = 5, .first = first}, .paths = paths, .count = 20},
                     testing::run_on_threads)
        .back();
  };
  EXPECT_EQ(floors(0, 130).mean, floors(130, 0).mean);
  EXPECT_NE(floors(0, 130).mean, floors(0, 0).mean);
}

TEST(W2Floors, a_plant_that_is_off_stands_out_from_them) {
  const Planned planned(testing::short_scenario());
  const FloorSettings settings{.numbers = {.seed = 5}, .paths = kPaths, .count = kPaths};
  const auto floors =
      w2_floors(planned.particles, *planned.model, planned.policy, planned.belief,
                planned.scenario.disturbance.covariance, settings, controller::run_in_turn);
  PlantPool pool = testing::altered_plants(planned.scenario, Eigen::Vector3d(0.1, 0.0, 0.0));
  const auto horizon = compare_along_horizon(
      paths_of(pool, planned),
      model_paths(*planned.model, planned.source(), kPaths, controller::run_in_turn),
      planned.particles, planned.scenario.safe_set, {.w2_paths = kPaths}, controller::run_in_turn);
  EXPECT_GT(horizon.back().w2, floors.back().mean + 5.41 * 1.07 * floors.back().deviation);
}

TEST(W2Paths, are_fewer_where_there_are_many_particles) {
  controller::DiscreteMeasure measure{.locations = controller::Points::Zero(2, 1000),
                                      .weights = Eigen::VectorXd::Constant(1000, 1e-3)};
  EXPECT_EQ(w2_paths({measure}, 1000), 200);
  measure = {.locations = controller::Points::Zero(2, 10),
             .weights = Eigen::VectorXd::Constant(10, 0.1)};
  EXPECT_EQ(w2_paths({measure}, 1000), 1000);
}

TEST(SimulationSpeed, is_a_positive_number) {
  const Planned planned(testing::short_scenario());
  const std::unique_ptr<Plant> plant = make_plant(planned.scenario);
  EXPECT_GT(simulation_speed(*plant, planned.source(), planned.scenario.time_step, 3), 0.0);
}

}  // namespace path_ensemble_test
}  // namespace qsmpc::harness
