// The effect of `--set KEY=VALUE` on a scenario.
#include "harness/scenario/overrides.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "models/constants.hpp"
#include "tests/unit/scenario/scenario_fixture.hpp"

namespace qsmpc::harness {
namespace overrides_test {

using ::testing::HasSubstr;

TEST(Overrides, replace_add_and_reach_into_lists) {
  EXPECT_EQ(minimal_with({"controller.horizon=12"}).controller.horizon, 12);
  EXPECT_EQ(minimal_with({"seed=1", "seed=2"}).seed, 2U);
  const Scenario scenario =
      minimal_with({"safe_set.obstacles=[{x: [2, 3], y: [0, 1]}]", "safe_set.obstacles.0.x=[1,2]",
                    "safe_set.obstacles.1.x=[7, 8]"});
  ASSERT_EQ(scenario.safe_set.obstacles.size(), 2U);
  EXPECT_EQ(scenario.safe_set.obstacles[0].box()->lower[0], 1.0);
  EXPECT_EQ(scenario.safe_set.obstacles[0].box()->upper[1], 1.0);
  EXPECT_EQ(scenario.safe_set.obstacles[1].box()->upper[0], 8.0);
  EXPECT_EQ(scenario.safe_set.obstacles[1].box()->upper[1], kInfinity);
}

TEST(Overrides, a_value_may_contain_an_equals_sign) {
  EXPECT_EQ(minimal_with({"description=a=b"}).description, "a=b");
}

struct BadOverride {
  std::string name;
  std::string text;
  std::string key;
  std::string found;
  std::string expected;
};

class BadOverrides : public ::testing::TestWithParam<BadOverride> {};

TEST_P(BadOverrides, is_reported_with_set_and_its_key) {
  const InputError::Where where = refusal_of(minimal_text, {GetParam().text});
  EXPECT_EQ(where.file, "--set");
  EXPECT_EQ(where.line, 0);
  EXPECT_EQ(where.key, GetParam().key);
  EXPECT_THAT(where.found, HasSubstr(GetParam().found));
  EXPECT_THAT(where.expected, HasSubstr(GetParam().expected));
}

INSTANTIATE_TEST_SUITE_P(
    All, BadOverrides,
    ::testing::Values(
        BadOverride{"no_equals", "horizon", "", "horizon", "KEY=VALUE"},
        BadOverride{"no_key", "=3", "", "=3", "KEY=VALUE"},
        BadOverride{"empty_part", "a..b=3", "a..b", "empty part", "names joined by dots"},
        BadOverride{"unknown_key", "controller.horzon=3", "controller.horzon", "an unknown key",
                    "horizon"},
        BadOverride{"unknown_section", "contoller.horizon=3", "contoller", "an unknown key",
                    "controller"},
        BadOverride{"wrong_type", "controller.horizon=x", "controller.horizon", "x", "whole"},
        BadOverride{"no_value", "controller.horizon=", "controller.horizon", "nothing", "whole"},
        BadOverride{"not_closed", "controller.horizon=[1", "controller.horizon", "not closed",
                    "a name"},
        BadOverride{"not_yaml", "controller.horizon=]", "controller.horizon", "not YAML", "YAML"},
        BadOverride{"two_documents", "seed=1\n---\n2", "seed", "a second document", "one"},
        BadOverride{"through_a_value", "name.first=x", "name.first", "the value test", "a mapping"},
        BadOverride{"past_the_end", "target.state.4=1", "target.state.4", "4", "from 0 to 3"},
        BadOverride{"no_index", "target.state.x=1", "target.state.x", "x", "an index"},
        BadOverride{"one_too_many", "target.state.3=1", "target.state", "a list of 4", "3 numbers"},
        BadOverride{"indefinite", "initial_state.covariance=[1, 1, -1]", "initial_state.covariance",
                    "eigenvalue -1", "semidefinite"},
        BadOverride{"controller", "controller.kind=quantized", "controller.kind", "quantized",
                    "quantised (known: quantised, nominal, lqr, "},
        BadOverride{"lqr_of_another", "controller.lqr.about=target", "controller.lqr.about",
                    "target", "path, or controller.kind: lqr"},
        BadOverride{"estimator", "estimator.kind=kalman", "estimator.kind", "kalman",
                    "one of exact, last_measurement"},
        BadOverride{"bounding", "controller.input_bounding=sigmod", "controller.input_bounding",
                    "sigmod", "sigmoid (known: bounded, sigmoid"},
        BadOverride{"item", "target.state.0=north", "target.state.0", "north", "a finite number"}),
    [](const auto& test) { return test.param.name; });

TEST(Overrides, an_exact_estimator_is_refused_with_measurement_noise) {
  const InputError::Where where =
      refusal_of(minimal_text, {"disturbance.sensor=[1, 1, 1]", "estimator.kind=exact"});
  EXPECT_EQ(where.key, "estimator.kind");
  EXPECT_THAT(where.expected, HasSubstr("last_measurement"));
}

TEST(Overrides, a_hostile_key_is_refused) {
  std::string key = "a";
  for (int i = 0; i < 100000; ++i) key += ".a";
  EXPECT_EQ(refusal_of(minimal_text, {key + "=1"}).file, "--set");
}

}  // namespace overrides_test
}  // namespace qsmpc::harness
