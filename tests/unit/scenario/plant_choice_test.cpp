// Plants by name.
#include "harness/scenario/plant_choice.hpp"

#include <filesystem>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "harness/errors.hpp"
#include "harness/scenario/scenario_file.hpp"
#include "harness/scenario/shipped_files.hpp"

namespace qsmpc::harness {
namespace plant_choice_test {

using ::testing::EndsWith;
using ::testing::HasSubstr;

TEST(PlantChoice, every_system_has_a_plant_in_joints_and_every_file_is_there) {
  std::set<std::string> systems_with_plants;
  for (const ShippedPlant& plant : shipped_plants()) {
    EXPECT_NE(find_mjcf(plant.mjcf, ""), "") << plant.mjcf;
    systems_with_plants.insert(plant.system);
  }
  for (const models::SystemEntry& system : models::systems()) {
    EXPECT_TRUE(systems_with_plants.contains(system.name)) << system.name;
  }
}

TEST(PlantChoice, the_same_name_is_another_file_for_another_system) {
  EXPECT_THAT(with_plant(load_scenario("dubins_corridor"), "mujoco_car").plant.mjcf,
              EndsWith("dubins_car.xml"));
  EXPECT_THAT(with_plant(load_scenario("bicycle_obstacles"), "mujoco_car").plant.mjcf,
              EndsWith("bicycle_car.xml"));
}

TEST(PlantChoice, mujoco_is_the_default_vehicle_where_the_scenario_names_none) {
  const Scenario scenario = load_scenario("double_integrator");
  ASSERT_EQ(scenario.plant.mjcf, "");
  EXPECT_EQ(with_plant(scenario, "mujoco").plant.mjcf,
            load_scenario("double_integrator", {"plant.kind=mujoco"}).plant.mjcf);
}

TEST(PlantChoice, a_mapping_and_a_time_step_stay_with_their_own_file) {
  const Scenario robot = load_scenario("differential_robot", {"plant.time_step=0.001"});
  ASSERT_TRUE(robot.plant.mapping.has_value());
  const Scenario own = with_plant(robot, "mujoco");
  EXPECT_TRUE(own.plant.mapping.has_value());
  EXPECT_EQ(own.plant.time_step, 0.001);
  const Scenario other = with_plant(robot, "mujoco_planar");
  EXPECT_FALSE(other.plant.mapping.has_value());
  EXPECT_FALSE(other.plant.time_step.has_value());
  EXPECT_EQ(with_plant(robot, "analytic").plant.kind, "analytic");
}

TEST(PlantChoice, an_unknown_name_is_refused_with_those_that_the_system_has) {
  try {
    (void)with_plant(load_scenario("double_integrator"), "mujoco_car");
    FAIL() << "not refused";
  } catch (const InputError& error) {
    EXPECT_EQ(error.where().key, "--plant");
    EXPECT_THAT(error.where().expected, HasSubstr("mujoco_slider"));
  }
  EXPECT_THROW((void)with_plant(load_scenario("dubins_corridor"), "no_such.xml"), InputError);
}

TEST(PlantChoice, a_path_is_taken_from_the_working_folder) {
  const auto before = std::filesystem::current_path();
  std::filesystem::current_path(shipped_models_folder() + "/mjcf");
  const Scenario scenario = with_plant(load_scenario("dubins_corridor"), "./dubins_planar.xml");
  std::filesystem::current_path(before);
  EXPECT_THAT(scenario.plant.mjcf, EndsWith("mjcf/dubins_planar.xml"));
  EXPECT_EQ(scenario.plant.kind, "mujoco");
}

}  // namespace plant_choice_test
}  // namespace qsmpc::harness
