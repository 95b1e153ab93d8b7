// The keys of sampling controllers: read, written, and refused where they have no effect.
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "harness/assembly/assembly.hpp"
#include "harness/scenario/certificate_scope.hpp"
#include "tests/unit/scenario/scenario_fixture.hpp"
#include "tests/unit/scenario/scenario_round_trip.hpp"

namespace qsmpc::harness {
namespace mppi_keys_test {

using controller::MppiSettings;
using ::testing::HasSubstr;
using ::testing::Not;

/// Every key with a non-default value, and whether a kind uses it.
struct Entry {
  std::string key;
  std::string value;
  bool of_mppi = true;
  bool of_risk_mppi = true;
};

const std::vector<Entry>& entries() {
  static const std::vector<Entry> all = {
      {"samples", "77"},
      {"iterations", "4"},
      {"temperature", "12.5"},
      {"effective_share", "0.31"},
      {"spread", "0.11"},
      {"correlation", "0.13"},
      {"control_term", "0.77"},
      {"smoothing", "5"},
      {"obstacle_cost", "123"},
      {"proximity_cost", "45"},
      {"margin", "0.77"},
      {"noise", "true", true, false},
      {"noise_paths", "9", false, true},
      {"cvar", "0.55", false, true},
  };
  return all;
}

TEST(MppiKeys, are_read_and_written_under_the_kinds_that_use_them) {
  for (const bool risk : {false, true}) {
    const std::string kind = risk ? "risk_mppi" : "mppi";
    for (const Entry& entry : entries()) {
      SCOPED_TRACE(kind + " " + entry.key);
      const std::string key = "controller.mppi." + entry.key;
      const std::vector<std::string> overrides = {"controller.kind=" + kind,
                                                  key + "=" + entry.value};
      if (risk ? !entry.of_risk_mppi : !entry.of_mppi) {
        const auto where = refusal_of(minimal_text, overrides);
        EXPECT_EQ(where.key, key);
        EXPECT_THAT(where.expected, HasSubstr("or controller.kind: "));
        continue;
      }
      const Scenario scenario = minimal_with(overrides);
      EXPECT_FALSE(scenario.controller.mppi == MppiSettings{});
      EXPECT_TRUE(controller_settings(scenario).mppi == scenario.controller.mppi);
      EXPECT_THAT(to_yaml(scenario), HasSubstr("    " + entry.key + ": " + entry.value + "\n"));
      expect_round_trip(scenario);
    }
  }
}

TEST(MppiKeys, may_hold_their_defaults_under_other_kinds_and_nothing_else) {
  EXPECT_THAT(to_yaml(minimal_with({})), Not(HasSubstr("effective_share")));
  const MppiSettings usual;
  EXPECT_TRUE(
      minimal_with({"controller.mppi.samples=" + std::to_string(usual.samples)}).controller.mppi ==
      usual);
  for (const Entry& entry : entries()) {
    const std::string key = "controller.mppi." + entry.key;
    EXPECT_EQ(refusal_of(minimal_text, {key + "=" + entry.value}).key, key);
  }
}

TEST(MppiKeys, a_share_beside_a_temperature_would_do_nothing) {
  const auto where =
      refusal_of(minimal_text, {"controller.kind=mppi", "controller.mppi.temperature=3",
                                "controller.mppi.effective_share=0.31"});
  EXPECT_EQ(where.key, "controller.mppi.effective_share");
  EXPECT_THAT(where.expected, HasSubstr("no controller.mppi.temperature"));
  EXPECT_EQ(
      refusal_of(minimal_text, {"controller.kind=mppi", "controller.mppi.smoothing=1"}).expected,
      "0, or at least 2");
}

TEST(MppiKeys, its_plans_have_no_feedback_and_its_messages_no_policy) {
  const Scenario scenario =
      minimal_with({"controller.kind=mppi", "disturbance.sensor=[0.01, 0.01, 0.001]",
                    "controller.mppi.samples=512", "controller.horizon=7"});
  EXPECT_EQ(why_no_bound(scenario), "");
  EXPECT_EQ(controller_words(scenario), "mppi, 512 samples, horizon 7");
}

}  // namespace mppi_keys_test
}  // namespace qsmpc::harness
