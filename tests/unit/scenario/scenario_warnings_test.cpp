#include "harness/scenario/scenario_warnings.hpp"

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "harness/scenario/scenario_file.hpp"

namespace qsmpc::harness {
namespace scenario_warnings_test {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// 0.2 m and two standard deviations away from a wall.
Scenario at_a_wall(const std::string& rest) {
  return parse_scenario(
      "name: wall\nmodel: {system: dubins, speed: 1.5}\nplant: {kind: analytic, mjcf: \"\"}\n"
      "initial_state: {mean: [0.2, 0, 0], covariance: [0.01, 0.01, 0.01]}\n"
      "target: {state: [5, 0, 0]}\n" +
      rest);
}

constexpr const char* kWall = "safe_set: {bounds: {x: [0, 10]}}\n";

TEST(ScenarioWarnings, say_that_the_start_is_above_the_least_limit) {
  EXPECT_THAT(
      scenario_warnings(at_a_wall(std::string(kWall) + "risk: {plan: 0.5, stage: 0.02}\n")),
      ElementsAre("the start is unsafe with a certified probability of up to 0.0228, above the "
                  "limit of 0.02"));
  EXPECT_THAT(scenario_warnings(at_a_wall(std::string(kWall) + "risk: {mission: 0.03}\n")),
              IsEmpty());
  EXPECT_THAT(scenario_warnings(at_a_wall(kWall)), IsEmpty());
}

TEST(ScenarioWarnings, count_the_body) {
  const std::string limited = std::string(kWall) + "risk: {mission: 0.1}\n";
  EXPECT_THAT(scenario_warnings(at_a_wall(limited)), IsEmpty());
  EXPECT_THAT(scenario_warnings(at_a_wall(limited + "vehicle: {footprint: [{radius: 0.15}]}\n")),
              ElementsAre(HasSubstr("up to 0.309")));  // half a standard deviation
}

TEST(ScenarioWarnings, say_that_no_certificate_is_0) {
  EXPECT_THAT(scenario_warnings(at_a_wall(std::string(kWall) + "risk: {plan: 0}\n")),
              ElementsAre(HasSubstr("risk.plan is 0")));
  // Nothing is unsafe: the risk is 0.
  EXPECT_THAT(scenario_warnings(at_a_wall("risk: {plan: 0}\n")), IsEmpty());
}

}  // namespace scenario_warnings_test
}  // namespace qsmpc::harness
