// Certificates that are not bounds, and the warnings before the first period.
#include "harness/scenario/certificate_scope.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "harness/scenario/scenario_warnings.hpp"
#include "tests/unit/scenario/scenario_fixture.hpp"

namespace qsmpc::harness {
namespace certificate_scope_test {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

const std::string noisy = "disturbance.sensor=[0.01, 0.01, 0.001]";

TEST(CertificateScope, is_lost_with_measurement_noise_and_feedback_and_with_neither_alone) {
  EXPECT_EQ(why_no_bound(minimal_with({})), "");
  EXPECT_THAT(why_no_bound(minimal_with({noisy})), HasSubstr("disturbance.sensor"));
  EXPECT_EQ(why_no_bound(minimal_with({noisy, "controller.policy=open_loop"})), "");
  EXPECT_EQ(why_no_bound(minimal_with({"disturbance.sensor=[0, 0, 0]"})), "");
}

TEST(CertificateScope, depends_on_what_the_policy_does) {
  EXPECT_EQ(why_no_bound(minimal_with({noisy, "controller.feedback_gain=[0, 0, 0]"})), "");
  EXPECT_NE(why_no_bound(minimal_with({noisy, "controller.feedback_gain=[0, 0, 1]"})), "");
  EXPECT_NE(why_no_bound(minimal_with({noisy, "controller.kind=lqr"})), "");
  // A tube has feedback whatever its policy, and the controller inside a shield may have it.
  for (const char* kind : {"tube", "shield"}) {
    EXPECT_NE(why_no_bound(minimal_with(
                  {noisy, "controller.policy=open_loop", std::string("controller.kind=") + kind})),
              "");
  }
}

TEST(CertificateScope, is_warned_of) {
  EXPECT_THAT(scenario_warnings(minimal_with({noisy})),
              ElementsAre(HasSubstr("no certificate is a bound: with measurement noise")));
}

TEST(ScenarioWarnings, warn_of_angles_that_look_like_degrees) {
  EXPECT_THAT(
      scenario_warnings(minimal_with({"initial_state.mean=[0, 0, 90]"})),
      ElementsAre("initial_state.mean: heading = 90 is more than a full turn: angles are in "
                  "radians; 90 degrees are 1.571"));
  EXPECT_THAT(scenario_warnings(minimal_with({"target.state=[5, 0, -45]"})),
              ElementsAre(HasSubstr("target.state: heading = -45")));
  // Up to whole turns a number counts as an angle; a position of 90 m is fine.
  EXPECT_THAT(scenario_warnings(minimal_with({"initial_state.mean=[90, 0, 6.28]"})), IsEmpty());
}

}  // namespace certificate_scope_test
}  // namespace qsmpc::harness
