// What simulator faults leave of an episode.
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "harness/episode/episode.hpp"
#include "harness/scenario/scenario_file.hpp"

namespace qsmpc::harness {
namespace episode_faults_test {

/// A short drive in MuJoCo with a defect.
Scenario broken_scenario(const std::vector<std::string>& wrong) {
  std::vector<std::string> overrides = {
      "controller.horizon=5", "controller.quantisation={state: 20, noise: 20, compressed: 20}",
      "limit.steps=12", "plant.kind=mujoco", "vehicle.footprint=point"};
  overrides.insert(overrides.end(), wrong.begin(), wrong.end());
  return load_scenario("dubins_obstacles", overrides);
}

TEST(EpisodeFaults, a_plant_that_breaks_is_an_outcome_with_the_simulators_message) {
  const Scenario scenario = broken_scenario({"disturbance.covariance=[1e24, 1e24, 0]"});
  const Trace trace = run_episode(scenario, {.seed = 1});
  EXPECT_EQ(trace.outcome, Outcome::kFault);
  EXPECT_FALSE(trace.fault.empty());
  EXPECT_TRUE(trace.final_state.allFinite());
  ASSERT_FALSE(trace.steps.empty());
  EXPECT_TRUE(trace.steps.back().residual.array().isNaN().all());
  EXPECT_EQ(trace.steps.back().residual.size(), 3);
}

TEST(EpisodeFaults, an_xml_file_that_mujoco_refuses_is_a_fault_with_its_message) {
  const std::filesystem::path file =
      std::filesystem::temp_directory_path() / "qsmpc_episode_bad.xml";
  std::ofstream(file) << "<mujoco><worldbody><no_such_element/></worldbody></mujoco>";
  const Scenario scenario = broken_scenario({"plant.mjcf=" + file.string()});
  const Trace trace = run_episode(scenario, {.seed = 1});
  std::filesystem::remove(file);
  EXPECT_EQ(trace.outcome, Outcome::kFault);
  EXPECT_TRUE(trace.steps.empty());
  EXPECT_THAT(trace.fault, ::testing::HasSubstr("no_such_element"));
}

}  // namespace episode_faults_test
}  // namespace qsmpc::harness
