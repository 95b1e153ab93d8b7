// Simulator faults, and models that are refused.
#include <cstdlib>
#include <filesystem>
#include <limits>
#include <string>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "harness/errors.hpp"
#include "harness/mujoco/mujoco_errors.hpp"
#include "harness/mujoco/mujoco_model.hpp"
#include "harness/threads/interruption.hpp"
#include "models/constants.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/unit/plant/plant_fixture.hpp"

namespace qsmpc::harness {
namespace mujoco_plant_fault_test {

using ::testing::AllOf;
using ::testing::HasSubstr;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

InputError::Where refusal(const std::string& mjcf, double control_period = kControlPeriod) {
  try {
    make_car(mjcf, control_period);
  } catch (const InputError& error) {
    return error.where();
  }
  ADD_FAILURE() << "not refused";
  return {};
}

/// Runs in its own folder, where MuJoCo would write its log.
class MujocoPlantFault : public ::testing::Test {
 protected:
  MujocoPlantFault() { std::filesystem::current_path(folder_.path()); }
  ~MujocoPlantFault() override {
    EXPECT_FALSE(std::filesystem::exists("MUJOCO_LOG.TXT"));
    std::filesystem::current_path(before_);
  }

  std::filesystem::path before_ = std::filesystem::current_path();
  testing::TemporaryFolder folder_;
};

TEST_F(MujocoPlantFault, input_or_disturbance_that_is_not_finite) {
  const auto car = make_car();
  for (const double bad : {kNan, kInfinity, -kInfinity}) {
    car->reset(pose(1.0, 2.0, 3.0));
    const PlantStep step = car->advance(yaw_rate(bad), no_disturbance());
    ASSERT_TRUE(step.fault.has_value());
    EXPECT_EQ(*step.fault, "input that is not finite at 0.000 s");
    EXPECT_EQ(step.state, pose(1.0, 2.0, 3.0));
    EXPECT_TRUE(step.motion.empty());

    car->reset(pose(1.0, 2.0, 3.0));
    EXPECT_TRUE(car->advance(yaw_rate(0.0), pose(0.0, bad, 0.0)).fault.has_value());
  }
}

TEST_F(MujocoPlantFault, so_many_steps_that_no_period_would_end_are_refused) {
  std::string text = altered_car("timestep=\"0.002\"", "timestep=\"1e-9\"");
  const std::string allowed = "time_steps: [0.0005,";
  text.replace(text.find(allowed), allowed.size(), "time_steps: [1e-9,");
  const InputError::Where where = refusal(folder_.file("car.xml", text));
  EXPECT_EQ(where.key, "option timestep");
  EXPECT_EQ(where.found, "1e-09 s, 1e+08 steps in a control period");
  EXPECT_THAT(where.expected, HasSubstr("at most 20000 steps in a control period of 0.1 s"));
}

using MujocoPlantFaultDeathTest = MujocoPlantFault;

TEST_F(MujocoPlantFaultDeathTest, a_period_ends_where_the_process_is_asked_to_stop) {
  const auto car = make_car();
  car->reset(pose(0.0, 0.0, 0.0));
  // In its own process: others have not received the request.
  EXPECT_EXIT(
      {
        note_interrupt();
        try {
          (void)car->advance(yaw_rate(0.0), no_disturbance());
        } catch (const Interrupted&) {
          std::_Exit(17);
        }
      },
      ::testing::ExitedWithCode(17), "");
}

TEST_F(MujocoPlantFault, a_place_beyond_what_mujoco_takes_is_its_error) {
  const auto car = make_car();
  try {
    car->reset(pose(1e11, 0.0, 0.0));
    FAIL();
  } catch (const SimulatorError& error) {
    EXPECT_THAT(error.where().found, HasSubstr("QPOS"));
  }
  EXPECT_NO_THROW(car->reset(pose(1.0, 0.0, 0.0)));
}

TEST_F(MujocoPlantFault, lasts_until_reset_and_is_then_forgotten) {
  const auto car = make_car();
  car->reset(pose(0.0, 0.0, 0.0));
  const PlantStep healthy = car->advance(yaw_rate(1.0), no_disturbance());
  const PlantStep broken = car->advance(yaw_rate(kNan), no_disturbance());
  const PlantStep after = car->advance(yaw_rate(1.0), no_disturbance());
  EXPECT_EQ(after.fault, broken.fault);
  EXPECT_EQ(after.state, healthy.state);
  car->reset(pose(0.0, 0.0, 0.0));
  const PlantStep again = car->advance(yaw_rate(1.0), no_disturbance());
  EXPECT_FALSE(again.fault.has_value());
  EXPECT_EQ(again.state, healthy.state);
}

TEST_F(MujocoPlantFault, a_simulation_that_explodes_stops_at_its_last_good_state) {
  // An unbounded torque instead of the servo: zero while driving straight, then excessive.
  const std::string text = altered_car(
      "<position class=\"steering\" name=\"steer_left\" joint=\"front_left_steering\"/>",
      "<motor name=\"steer_left\" joint=\"front_left_steering\" gear=\"1e13\"/>");
  const auto car = make_car(folder_.file("car.xml", text));
  car->reset(pose(0.0, 0.0, 0.0));
  const PlantStep straight = car->advance(yaw_rate(0.0), no_disturbance());
  ASSERT_FALSE(straight.fault.has_value()) << *straight.fault;
  const PlantStep step = car->advance(yaw_rate(1.0), no_disturbance());
  ASSERT_TRUE(step.fault.has_value());
  EXPECT_THAT(*step.fault, AllOf(HasSubstr("The simulation is unstable"), HasSubstr(" at 0.1")));
  // After a silent reset the car would be at the origin.
  EXPECT_NEAR(step.state[0], 0.15, 0.05);
  EXPECT_TRUE(step.state.allFinite());
  for (const MotionSample& sample : step.motion) EXPECT_LT(std::abs(sample.qpos[0]), 1.0);
}

TEST_F(MujocoPlantFault, a_kick_out_of_the_simulators_range) {
  const auto car = make_car();
  car->reset(pose(0.0, 0.0, 0.0));
  const PlantStep step = car->advance(yaw_rate(0.0), pose(1e11, 0.0, 0.0));
  ASSERT_TRUE(step.fault.has_value());
  EXPECT_THAT(*step.fault, AllOf(HasSubstr("QPOS at DOF 0"), HasSubstr("at 0.100 s")));
  EXPECT_NEAR(step.state[0], 0.15, 1e-4);
}

TEST_F(MujocoPlantFault, refuses_a_model_whose_buffers_are_too_small) {
  // Four wheels touch but there is room for three contacts: refused at settling.
  const auto where =
      refusal(folder_.file("car.xml", altered_car("nconmax=\"50\"", "nconmax=\"3\"")));
  EXPECT_THAT(where.found, HasSubstr("contact"));
}

TEST_F(MujocoPlantFault, arguments_of_a_wrong_size_throw) {
  const auto car = make_car();
  EXPECT_THROW(car->reset(Eigen::VectorXd::Zero(2)), std::invalid_argument);
  EXPECT_THROW(car->reset(pose(kNan, 0.0, 0.0)), std::invalid_argument);
  EXPECT_THROW(car->advance(Eigen::VectorXd::Zero(2), no_disturbance()), std::invalid_argument);
  EXPECT_THROW(car->advance(yaw_rate(0.0), Eigen::VectorXd::Zero(2)), std::invalid_argument);
}

TEST_F(MujocoPlantFault, refuses_a_missing_file) {
  const auto where = refusal("no_such_car.xml");
  EXPECT_EQ(where.file, "no_such_car.xml");
  EXPECT_EQ(where.found, "no such file");
}

TEST_F(MujocoPlantFault, refuses_xml_that_is_malformed_or_not_a_model_and_names_the_line) {
  const std::string malformed = folder_.file("a.xml", "<mujoco>\n<worldbody>\n</mujoco>\n");
  EXPECT_EQ(refusal(malformed).file, malformed);
  EXPECT_EQ(refusal(malformed).line, 2);
  const auto unknown = refusal(folder_.file("b.xml", "<mujoco>\n\n<wordlbody/>\n</mujoco>\n"));
  EXPECT_EQ(unknown.line, 3);
  EXPECT_THAT(unknown.found, HasSubstr("unrecognized element"));
  const auto massless = refusal(folder_.file(
      "c.xml", "<mujoco><worldbody>\n<body><freejoint/></body>\n</worldbody></mujoco>"));
  EXPECT_EQ(massless.line, 2);
  EXPECT_THAT(massless.found, HasSubstr("mass and inertia"));
  EXPECT_FALSE(refusal(folder_.file("d.xml", "")).found.empty());
}

TEST_F(MujocoPlantFault, refuses_a_model_that_loads_with_a_warning) {
  const std::string file =
      folder_.file("car.xml", altered_car("pos=\"0 0.11 0\"", "pos=\"0 0.11 nan\""));
  EXPECT_THAT(refusal(file).found, HasSubstr("NaN"));
}

TEST_F(MujocoPlantFault, refuses_a_model_without_the_names_that_the_mapping_needs) {
  const auto body =
      refusal(folder_.file("a.xml", altered_car("<body name=\"car\"", "<body name=\"cra\"")));
  EXPECT_EQ(body.key, "body car");
  EXPECT_THAT(body.expected, AllOf(HasSubstr("cra"), HasSubstr("front_left")));
  const auto actuator =
      refusal(folder_.file("b.xml", altered_car("name=\"steer_right\"", "name=\"steer_rihgt\"")));
  EXPECT_EQ(actuator.key, "actuator steer_right");
  EXPECT_THAT(actuator.expected, AllOf(HasSubstr("steer_left"), HasSubstr("steer_rihgt")));
}

TEST_F(MujocoPlantFault, refuses_a_vehicle_that_cannot_hold_its_speed) {
  const auto where = refusal(folder_.file(
      "car.xml", altered_car("tendon=\"drive\" kv=\"3\"", "tendon=\"drive\" kv=\"0.0001\"")));
  EXPECT_THAT(where.found, HasSubstr("m/s after settling"));
}

TEST_F(MujocoPlantFault, refuses_a_period_that_is_not_a_multiple_of_the_timestep) {
  EXPECT_EQ(refusal(kCarFile, 0.101).key, "option timestep");
  EXPECT_EQ(refusal(kCarFile, 0.001).key, "option timestep");
  EXPECT_NO_THROW(make_car(kCarFile, 0.05));
}

TEST_F(MujocoPlantFault, a_warning_goes_to_the_innermost_trap_of_its_own_thread) {
  const std::string nan_model =
      folder_.file("car.xml", altered_car("pos=\"0 0.11 0\"", "pos=\"0 0.11 nan\""));
  const MujocoTrap outer;
  EXPECT_THROW((void)load_mujoco_model(nan_model), InputError);
  std::thread([&] { EXPECT_THROW((void)load_mujoco_model(nan_model), InputError); }).join();
  EXPECT_TRUE(outer.warnings().empty()) << "the loader's own trap collects its warnings";
}

}  // namespace mujoco_plant_fault_test
}  // namespace qsmpc::harness
