// Events between control instants: recorded, and distinguished from the outcome.
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "harness/episode/episode.hpp"
#include "harness/scenario/scenario_file.hpp"
#include "harness/trace/episode_view.hpp"
#include "harness/trace/trace_file.hpp"
#include "tests/support/temporary_folder.hpp"

namespace qsmpc::harness {
namespace between_instants_test {

/// A car drives straight on at 0.15 m per period, without noise, past `obstacle`.
Scenario straight_on(const std::string& obstacle, const std::vector<std::string>& more = {}) {
  return parse_scenario(
      "name: straight\nmodel: {system: dubins, speed: 1.5}\nplant: {kind: mujoco, mjcf: "
      "dubins_planar.xml}\nvehicle: {footprint: point}\n"
      "initial_state: {mean: [0, 0, 0]}\ntarget: {state: [9, 0, 0], radius: 0.1}\n"
      "limit: {steps: 3}\nsafe_set: {obstacles: [" +
          obstacle +
          "]}\ncontroller:\n  horizon: 2\n  max_iterations: 5\n  penalty: {obstacle: 0}\n"
          "  quantisation: {state: 10, noise: 10, compressed: 10}\n",
      {.overrides = more});
}

const std::string thin_wall = "{x: [0.22, 0.23], y: [-1, 1]}";  // between 0.15 and 0.3
const std::string wall_far_aside = "{x: [0, 1], y: [5, 6]}";

nlohmann::json summary_of(const Trace& trace) {
  return nlohmann::json::parse(summary_json(EpisodeView(trace)));
}

TEST(BetweenInstants, a_wall_crossed_within_a_period_is_reported_and_changes_no_outcome) {
  const Trace trace = run_episode(straight_on(thin_wall), {});
  ASSERT_EQ(trace.steps.size(), 3U);
  EXPECT_EQ(trace.outcome, Outcome::kTimeout);
  EXPECT_GT(trace.steps[0].clearance_between, 0.0);
  EXPECT_LE(trace.steps[1].clearance_between, 0.0);
  EXPECT_GT(trace.steps[2].clearance_between, 0.0);
  EXPECT_EQ(summary_of(trace)["collision"], false);
  EXPECT_EQ(summary_of(trace)["unsafe_between"], true);
}

TEST(BetweenInstants, a_free_way_is_safe_there_too) {
  const Trace trace = run_episode(straight_on(wall_far_aside), {});
  EXPECT_NEAR(trace.steps[1].clearance_between, 5.0, 1e-6);
  EXPECT_EQ(summary_of(trace)["unsafe_between"], false);
  EXPECT_TRUE(summary_of(trace)["contact"]["count"].is_null());
}

TEST(BetweenInstants, nothing_is_known_of_a_plant_without_a_simulator) {
  const Trace trace = run_episode(straight_on(thin_wall, {"plant.kind=analytic"}), {});
  EXPECT_TRUE(std::isnan(trace.steps[1].clearance_between));
  EXPECT_TRUE(summary_of(trace)["unsafe_between"].is_null());
}

TEST(SolidEpisode, has_its_contacts_in_trace_and_summary) {
  const Scenario scenario =
      straight_on("{x: [0.65, 2], y: [-1, 1]}", {"plant.solid=true", "limit.steps=8"});
  const Trace trace = run_episode(scenario, {});
  const Summary summary = EpisodeView(trace).summary();
  EXPECT_EQ(summary.contacts, 1);
  ASSERT_TRUE(summary.first_contact.has_value());
  EXPECT_NEAR(*summary.first_contact, 0.25 / 1.5, 0.02);  // the front is at 0.4 m
  EXPECT_GT(summary.largest_contact, 0.0);

  const testing::TemporaryFolder folder;
  write_trace(folder / "episode.h5", trace);
  const Trace again = read_trace(folder / "episode.h5");
  ASSERT_EQ(again.steps.size(), trace.steps.size());
  for (std::size_t k = 0; k < trace.steps.size(); ++k) {
    EXPECT_EQ(again.steps[k].clearance_between, trace.steps[k].clearance_between);
    EXPECT_EQ(again.steps[k].contact.force, trace.steps[k].contact.force);
    EXPECT_EQ(std::isnan(again.steps[k].contact.time), std::isnan(trace.steps[k].contact.time));
  }
  EXPECT_EQ(summary_of(again)["contact"], summary_of(trace)["contact"]);
  EXPECT_EQ(summary_of(again)["contact"]["count"], 1);
}

}  // namespace between_instants_test
}  // namespace qsmpc::harness
