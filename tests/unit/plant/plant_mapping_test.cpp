// Vehicles that the mapping alone makes drivable: what it reads, sets and commands, and what is
// refused.
#include <cmath>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "harness/errors.hpp"
#include "harness/plant/plant_registry.hpp"
#include "harness/scenario/scenario_file.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/unit/plant/plant_fixture.hpp"
#include "tests/unit/plant/shipped_plants.hpp"

namespace qsmpc::harness {
namespace plant_mapping_test {

using ::testing::AllOf;
using ::testing::HasSubstr;

// A mass on a rail with sensors, in other units: the joint in cm, the motor in mN.
constexpr const char* kRail = R"(<mujoco>
  <option timestep="0.01" integrator="RK4" gravity="0 0 0"><flag contact="disable"/></option>
  <worldbody>
    <body name="base">
      <joint name="slide" type="slide" axis="1 0 0"/>
      <geom type="sphere" size="0.1" mass="2"/>
    </body>
    <body name="other"><joint name="swing" type="hinge" axis="0 1 0"/>
      <geom type="sphere" size="0.1" mass="1" pos="1 0 0"/></body>
  </worldbody>
  <actuator><motor name="pull" joint="slide"/></actuator>
  <sensor><jointpos name="where" joint="slide"/><jointvel name="how_fast" joint="slide"/></sensor>
</mujoco>
)";

/// A double integrator on the rail; `plant` replaces the mapping unless it is empty.
Scenario rail_scenario(const std::string& file, const std::string& plant = "") {
  const std::string mapping = plant.empty()
                                  ? "state: {position: {joint: slide, gain: 100, offset: 5}, "
                                    "velocity: {joint: slide, quantity: velocity, gain: 100}}, "
                                    "input: {acceleration: [{actuator: pull, gain: 0.02}]}"
                                  : plant;
  return parse_scenario(
      "name: rail\nmodel: {system: double_integrator}\nplant: {kind: mujoco, mjcf: " + file +
          ", settling: 0, " + mapping +
          "}\ninitial_state: {mean: [0, 0]}\ntarget: {state: [2, 0]}\n",
      {.file = "rail.yaml", .folder = ""});
}

class PlantMappingTest : public ::testing::Test {
 protected:
  InputError::Where refusal(const std::string& mapping) {
    try {
      (void)make_plant(rail_scenario(file_, mapping));
    } catch (const InputError& error) {
      return error.where();
    }
    ADD_FAILURE() << "not refused: " << mapping;
    return {};
  }

  testing::TemporaryFolder folder_;
  std::string file_ = folder_.file("rail.xml", kRail);
};

TEST_F(PlantMappingTest, gain_and_offset_turn_units_both_ways) {
  const auto plant = make_plant(rail_scenario(file_));
  const MotionSample start = plant->reset(Eigen::Vector2d(25.0, 30.0));
  EXPECT_NEAR(start.qpos[0], 0.2, 1e-15);  // (25 - 5)/100
  // 50 cm/s² for 0.1 s: 0.02 N each, on 2 kg.
  const PlantStep step =
      plant->advance(Eigen::VectorXd::Constant(1, 50.0), Eigen::Vector2d::Zero());
  EXPECT_NEAR(step.state[0], 25.0 + 3.0 + 0.25, 1e-12);
  EXPECT_NEAR(step.state[1], 35.0, 1e-12);
}

TEST_F(PlantMappingTest, a_resolved_scenario_holds_the_mapping) {
  const Scenario scenario = rail_scenario(file_);
  const Scenario again = parse_scenario(to_yaml(scenario), {.file = "again.yaml", .folder = ""});
  EXPECT_EQ(to_yaml(again), to_yaml(scenario));
  ASSERT_TRUE(again.plant.mapping.has_value());
  EXPECT_EQ(again.plant.mapping->states.at("position").gain, 100.0);
  EXPECT_EQ(again.plant.mapping->inputs.at("acceleration").front().actuator, "pull");
}

TEST_F(PlantMappingTest, a_missing_name_is_refused_with_those_that_exist) {
  const std::string input = "input: {acceleration: [{actuator: pull}]}";
  const std::string velocity = "velocity: {joint: slide, quantity: velocity}";
  const auto joint = refusal("state: {position: {joint: slied}, " + velocity + "}, " + input);
  EXPECT_EQ(joint.key, "joint slied");
  EXPECT_THAT(joint.expected, AllOf(HasSubstr("slide"), HasSubstr("swing")));
  const auto body =
      refusal("state: {position: {body: bsae, quantity: x}, " + velocity + "}, " + input);
  EXPECT_EQ(body.key, "body bsae");
  EXPECT_THAT(body.expected, AllOf(HasSubstr("base"), HasSubstr("other")));
  const auto sensor = refusal("state: {position: {sensor: here}, " + velocity + "}, " + input);
  EXPECT_EQ(sensor.key, "sensor here");
  EXPECT_THAT(sensor.expected, AllOf(HasSubstr("where"), HasSubstr("how_fast")));
  const auto component =
      refusal("state: {position: {sensor: where, component: 1}, " + velocity + "}, " + input);
  EXPECT_THAT(component.expected, HasSubstr("0 to 0"));
  const auto actuator = refusal("state: {position: {joint: slide}, " + velocity +
                                "}, input: {acceleration: [{actuator: push}]}");
  EXPECT_EQ(actuator.key, "actuator push");
  EXPECT_THAT(actuator.expected, HasSubstr("pull"));
}

TEST_F(PlantMappingTest, states_that_one_quantity_would_have_to_serve_are_refused) {
  const auto where = refusal(
      "state: {position: {joint: slide}, velocity: {joint: slide}}, "
      "input: {acceleration: [{actuator: pull}]}");
  EXPECT_THAT(where.key, HasSubstr("state"));
  EXPECT_THAT(where.found, HasSubstr("another state determines"));
}

TEST_F(PlantMappingTest, sensors_are_read_and_not_set) {
  const auto plant =
      make_plant(rail_scenario(file_,
                               "state: {position: {joint: slide}, velocity: {sensor: how_fast}}, "
                               "input: {acceleration: [{actuator: pull, gain: 2}]}"));
  plant->reset(Eigen::Vector2d(1.0, 3.0));
  EXPECT_EQ(plant->state()[1], 0.0);
  const PlantStep step =
      plant->advance(Eigen::VectorXd::Constant(1, 1.0), Eigen::Vector2d(0.5, 9.0));
  EXPECT_NEAR(step.state[0], 1.0 + 0.005 + 0.5, 1e-12);
  EXPECT_NEAR(step.state[1], 0.1, 1e-12);
}

TEST_F(PlantMappingTest, a_model_without_a_mapping_needs_one_in_the_scenario) {
  Scenario scenario = rail_scenario(file_);
  scenario.plant.mapping.reset();
  try {
    (void)make_plant(scenario);
    FAIL() << "not refused";
  } catch (const InputError& error) {
    EXPECT_EQ(error.where().file, file_);
    EXPECT_EQ(error.where().key, "plant.state");
  }
}

TEST_F(PlantMappingTest, an_input_acts_after_its_delay) {
  const std::string mapping =
      "state: {position: {joint: slide}, velocity: {joint: slide, quantity: velocity}}, "
      "input: {acceleration: [{actuator: pull, gain: 2}]}, input_delay: ";
  for (const double delay : {0.0, 0.04, 0.1, 0.25}) {
    const auto plant = make_plant(rail_scenario(file_, mapping + std::to_string(delay)));
    plant->reset(Eigen::Vector2d::Zero());
    Eigen::VectorXd state;
    for (int k = 0; k < 4; ++k) {
      const double input = k == 0 ? 1.0 : 0.0;  // a pulse in the first period
      state = plant->advance(Eigen::VectorXd::Constant(1, input), Eigen::Vector2d::Zero()).state;
    }
    EXPECT_NEAR(state[1], 0.1, 1e-12) << delay;
    EXPECT_NEAR(state[0], 0.1 * (0.4 - delay - 0.05), 1e-12) << delay;
  }
}

TEST_F(PlantMappingTest, a_control_moves_no_faster_than_its_rate) {
  // The motor's control rises from 0 to 2 at 40 /s: the impulse is less than that of a step by
  // 2 · 0.05/2 N s.
  const auto plant = make_plant(rail_scenario(
      file_,
      "state: {position: {joint: slide}, velocity: {joint: slide, quantity: velocity}}, "
      "input: {acceleration: [{actuator: pull, gain: 2}]}, rate_limit: {pull: 40}"));
  plant->reset(Eigen::Vector2d::Zero());
  const PlantStep step = plant->advance(Eigen::VectorXd::Constant(1, 1.0), Eigen::Vector2d::Zero());
  // In five steps of 0.01 s to 0.4, 0.8, … 2.0: 0.06 kg m/s, then 0.1 kg m/s, on 2 kg.
  EXPECT_NEAR(step.state[1], (0.01 * (0.4 + 0.8 + 1.2 + 1.6 + 2.0) + 0.1) / 2.0, 1e-12);
}

TEST(PlantTimeStep, is_refused_outside_of_what_the_file_allows) {
  MujocoPlantSetup setup = shipped_setup("dubins", "dubins_car.xml");
  setup.time_step = 0.01;
  EXPECT_THROW((void)make_mujoco_plant(setup), InputError);
  setup.time_step = 0.001;
  EXPECT_NO_THROW((void)make_mujoco_plant(setup));
}

TEST(PlantTurns, are_counted_by_joints_and_by_bodies) {
  for (const char* mjcf : {"dubins_planar.xml", "dubins_car.xml"}) {
    const auto plant = make_mujoco_plant(shipped_setup("dubins", mjcf));
    plant->reset(pose(0.0, 0.0, 20.0));
    EXPECT_EQ(plant->state()[2], 20.0);
    for (int k = 0; k < 60; ++k) {
      (void)plant->advance(yaw_rate(2.0), no_disturbance());
    }
    EXPECT_NEAR(plant->state()[2], 32.0, 0.3) << mjcf;
  }
}

double turned_after_a_second(const PlantVariation& variation, const char* system, const char* mjcf,
                             const Eigen::VectorXd& start, const Eigen::VectorXd& input) {
  MujocoPlantSetup setup = shipped_setup(system, mjcf);
  setup.variation = variation;
  const auto plant = make_mujoco_plant(setup);
  plant->reset(start);
  for (int k = 0; k < 10; ++k) {
    (void)plant->advance(input, Eigen::VectorXd::Zero(start.size()));
  }
  return plant->state()[2];
}

TEST(PlantVariation, changes_what_a_car_does_with_its_steering) {
  Eigen::VectorXd start(6);
  start << 0.0, 0.0, 0.0, 8.0, 0.0, 0.0;
  const Eigen::Vector2d input(0.0, 0.05);
  for (const char* mjcf : {"bicycle_planar.xml", "bicycle_car.xml"}) {
    const double turned = turned_after_a_second({}, "bicycle", mjcf, start, input);
    // Longer, heavier or on softer tyres, it turns less: it understeers.
    EXPECT_LT(turned_after_a_second({.wheelbase = 1.2}, "bicycle", mjcf, start, input),
              0.95 * turned)
        << mjcf;
    EXPECT_LT(turned_after_a_second({.mass = 1.2}, "bicycle", mjcf, start, input), 0.999 * turned)
        << mjcf;
    EXPECT_LT(turned_after_a_second({.friction = 0.8}, "bicycle", mjcf, start, input),
              0.999 * turned)
        << mjcf;
  }
  // The small car's steering uses its wheelbase, and the varied car's does as well.
  const Eigen::VectorXd rate = yaw_rate(1.0);
  const double turned =
      turned_after_a_second({}, "dubins", "dubins_car.xml", pose(0.0, 0.0, 0.0), rate);
  EXPECT_NE(turned, turned_after_a_second({.wheelbase = 1.1}, "dubins", "dubins_car.xml",
                                          pose(0.0, 0.0, 0.0), rate));
  EXPECT_NE(turned, turned_after_a_second({.friction = 0.7}, "dubins", "dubins_car.xml",
                                          pose(0.0, 0.0, 0.0), rate));
}

TEST(PlantVariation, of_nothing_that_the_plant_has_is_refused) {
  MujocoPlantSetup setup = shipped_setup("dubins", "dubins_planar.xml");
  setup.variation = {.friction = 1.1};
  EXPECT_THROW((void)make_mujoco_plant(setup), InputError);
  setup.variation = {.wheelbase = 1.1};
  EXPECT_THROW((void)make_mujoco_plant(setup), InputError);
  Scenario scenario = rail_scenario("double_integrator_slider.xml");
  scenario.plant.kind = "analytic";
  EXPECT_THROW((void)make_plant(scenario, {.mass = 1.1}), InputError);
}

TEST(PlantVariation, is_drawn_from_its_own_stream_with_the_given_deviations) {
  Scenario::Disturbance disturbance;
  disturbance.friction = 0.2;
  disturbance.mass = 0.05;
  double sum = 0.0;
  double squares = 0.0;
  constexpr int kEpisodes = 2000;
  for (int k = 0; k < kEpisodes; ++k) {
    const PlantVariation drawn = draw_variation(disturbance, static_cast<std::uint64_t>(k));
    EXPECT_EQ(drawn.wheelbase, 1.0);
    sum += std::log(drawn.friction);
    squares += std::log(drawn.mass) * std::log(drawn.mass);
  }
  EXPECT_NEAR(sum / kEpisodes, 0.0, 3.0 * 0.2 / std::sqrt(kEpisodes));
  EXPECT_NEAR(std::sqrt(squares / kEpisodes), 0.05, 3.0 * 0.05 / std::sqrt(2.0 * kEpisodes));
}

}  // namespace plant_mapping_test
}  // namespace qsmpc::harness
