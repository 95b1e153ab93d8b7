// The analytic plant and the table of plants.
#include "harness/plant/plant_registry.hpp"

#include <algorithm>
#include <limits>
#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "harness/errors.hpp"
#include "harness/plant/analytic_plant.hpp"
#include "tests/unit/plant/plant_fixture.hpp"

namespace qsmpc::harness {
namespace plant_registry_test {

Scenario dubins_scenario(const std::string& kind) {
  Scenario scenario;
  scenario.model = {.system = "dubins", .parameters = {{"speed", kSpeed}}};
  scenario.plant.kind = kind;
  scenario.plant.mjcf = kCarFile;
  scenario.time_step = kControlPeriod;
  return scenario;
}

TEST(AnalyticPlant, is_the_dynamics_plus_the_disturbance) {
  const auto plant = make_plant(dubins_scenario("analytic"));
  const auto model = models::make_dynamics("dubins", {{"speed", kSpeed}}, kControlPeriod);
  const MotionSample first = plant->reset(pose(1.0, 2.0, 3.0));
  EXPECT_EQ(first.time, 0.0);
  models::StateBatch expected = pose(1.0, 2.0, 3.0);
  const Eigen::VectorXd disturbance = pose(0.1, -0.2, 0.3);
  for (int k = 1; k <= 20; ++k) {
    models::StateBatch next(3, 1);
    model->step(expected, models::StateBatch(yaw_rate(0.1 * k)), next);
    expected = next.col(0) + disturbance;
    const PlantStep step = plant->advance(yaw_rate(0.1 * k), disturbance);
    EXPECT_EQ(step.state, Eigen::VectorXd(expected.col(0)));
    EXPECT_EQ(step.state, plant->state());
    EXPECT_FALSE(step.fault.has_value());
    ASSERT_EQ(step.motion.size(), 1U);
    EXPECT_DOUBLE_EQ(step.motion[0].time, 0.1 * k);
    EXPECT_TRUE(step.motion[0].qpos.empty());
  }
}

TEST(AnalyticPlant, keeps_its_last_good_state_at_a_fault_until_reset) {
  const auto plant = make_plant(dubins_scenario("analytic"));
  plant->reset(pose(1.0, 2.0, 3.0));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const PlantStep step = plant->advance(yaw_rate(nan), no_disturbance());
  ASSERT_TRUE(step.fault.has_value());
  EXPECT_EQ(*step.fault, "state that is not finite at 0.100 s");
  EXPECT_EQ(step.state, pose(1.0, 2.0, 3.0));
  EXPECT_EQ(plant->advance(yaw_rate(0.0), no_disturbance()).fault, step.fault);
  plant->reset(pose(0.0, 0.0, 0.0));
  EXPECT_FALSE(plant->advance(yaw_rate(0.0), no_disturbance()).fault.has_value());
  EXPECT_THROW(plant->reset(Eigen::VectorXd::Zero(1)), std::invalid_argument);
}

TEST(PlantRegistry, makes_every_plant_that_it_lists) {
  for (const PlantEntry& entry : plants()) {
    EXPECT_FALSE(entry.summary.empty()) << entry.name;
    const auto plant = make_plant(dubins_scenario(entry.name));
    plant->reset(pose(0.0, 0.0, 0.0));
    const PlantStep step = plant->advance(yaw_rate(0.0), no_disturbance());
    EXPECT_FALSE(step.fault.has_value()) << entry.name;
    EXPECT_NEAR(step.state[0], kSpeed * kControlPeriod, 1e-4) << entry.name;
  }
}

TEST(PlantRegistry, refuses_what_it_cannot_make) {
  EXPECT_THROW((void)make_plant(dubins_scenario("mujco")), InputError);
  Scenario scenario = dubins_scenario("mujoco");
  scenario.model.parameters["speed"] = 0.0;
  EXPECT_THROW((void)make_plant(scenario), InputError);
  scenario = dubins_scenario("mujoco");
  const auto bicycle = std::ranges::find(models::systems(), "bicycle", &models::SystemEntry::name);
  ASSERT_NE(bicycle, models::systems().end());
  scenario.model = {.system = "bicycle", .parameters = bicycle->defaults};
  EXPECT_THROW((void)make_plant(scenario), InputError);
}

}  // namespace plant_registry_test
}  // namespace qsmpc::harness
