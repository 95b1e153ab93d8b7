#include "harness/plant/mujoco/joint_pose.hpp"

#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "harness/scenario/scenario_file.hpp"
#include "tests/support/described_trace.hpp"

namespace qsmpc::harness {
namespace joint_pose_test {

TEST(JointPose, puts_states_that_are_joints_into_qpos) {
  Trace trace;
  trace.scenario = load_scenario("cart_pole");
  trace = testing::described(std::move(trace));
  const auto pose = JointPose::of(trace.scenario, trace.system, trace.scenario.plant.mjcf);
  ASSERT_TRUE(pose);
  EXPECT_THAT(pose->qpos(Eigen::Vector4d(0.5, 1.0, -1.2, 2.0)), ::testing::ElementsAre(0.5, -1.2));
}

}  // namespace joint_pose_test
}  // namespace qsmpc::harness
