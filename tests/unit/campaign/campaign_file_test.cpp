// What a campaign file expands to.
#include "harness/campaign/plan/campaign_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "harness/scenario/plant_choice.hpp"
#include "harness/scenario/scenario_file.hpp"
#include "harness/scenario/shipped_files.hpp"
#include "models/constants.hpp"
#include "tests/unit/campaign/campaign_folder.hpp"

namespace qsmpc::harness {
namespace campaign_campaign_file_test {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

TEST(CampaignFile, a_scenario_and_seeds_are_enough) {
  const CampaignFolder folder;
  const Campaign campaign = folder.load("scenario: a.yaml\nseeds: {count: 3}\n");
  EXPECT_EQ(campaign.name, "c");
  ASSERT_EQ(campaign.variants.size(), 1U);
  const CampaignVariant& variant = campaign.variants.front();
  EXPECT_EQ(variant.name, "test");
  EXPECT_EQ(variant.scenario, "a.yaml");
  EXPECT_EQ(variant.settings, "");
  EXPECT_EQ(variant.plant, "");
  EXPECT_THAT(variant.overrides, IsEmpty());
  EXPECT_EQ(campaign.seeds, (SeedSet{.first = 0, .count = 3}));
  EXPECT_EQ(campaign.traces, TraceKeeping::kNone);
  EXPECT_EQ(campaign.trace_sample, 0);
  EXPECT_EQ(campaign.episodes(), 3);
}

TEST(CampaignFile, every_key_is_read) {
  const CampaignFolder folder;
  const Campaign campaign = folder.load(
      "name: all keys\ndescription: of them\nscenarios: [a.yaml]\nseeds: [7, 3]\n"
      "traces: failures\ntrace_sample: 4\n"
      "until: {rate_halfwidth: 0.001, confidence: 0.999, of: collision}\n");
  EXPECT_EQ(campaign.name, "all keys");
  EXPECT_EQ(campaign.until,
            (StopCriterion{.of = "collision", .rate_halfwidth = 0.001, .confidence = 0.999}));
  EXPECT_THAT(campaign.seeds.listed, ElementsAre(7U, 3U));
  EXPECT_EQ(campaign.traces, TraceKeeping::kFailures);
  EXPECT_EQ(campaign.trace_sample, 4);
}

TEST(CampaignFile, a_rule_counts_unsafe_drives_at_99_percent_unless_it_says_otherwise) {
  const CampaignFolder folder;
  const std::string head = "scenario: a.yaml\nseeds: {count: 3}\n";
  EXPECT_EQ(folder.load(head).until, std::nullopt);
  EXPECT_EQ(folder.load(head + "until: {rate_halfwidth: 0.01}\n").until,
            (StopCriterion{.of = "unsafe", .rate_halfwidth = 0.01, .confidence = 0.99}));
}

TEST(CampaignFile, expands_scenarios_slowest_then_variants_then_the_grid_then_plants) {
  const CampaignFolder folder;
  const Campaign campaign = folder.load(
      "scenarios: [b.yaml, a.yaml]\n"
      "variants: {z: {controller.policy: open_loop}, base: {}}\n"
      "grid:\n  limit.steps: [9, 8]\n  controller.horizon: [2, 1]\n"
      "plants: [mujoco_car, analytic]\n"
      "seeds: [0]\n");
  ASSERT_EQ(campaign.variants.size(), 32U);
  const std::vector<std::string> names = names_of(campaign);
  EXPECT_EQ(names[0], "other / z, limit.steps=9, controller.horizon=2 / mujoco_car");
  EXPECT_EQ(names[1], "other / z, limit.steps=9, controller.horizon=2 / analytic");
  EXPECT_EQ(names[2], "other / z, limit.steps=9, controller.horizon=1 / mujoco_car");
  EXPECT_EQ(names[4], "other / z, limit.steps=8, controller.horizon=2 / mujoco_car");
  EXPECT_EQ(names[8], "other / base, limit.steps=9, controller.horizon=2 / mujoco_car");
  EXPECT_EQ(names[16], "test / z, limit.steps=9, controller.horizon=2 / mujoco_car");
  EXPECT_EQ(names[31], "test / base, limit.steps=8, controller.horizon=1 / analytic");
  const CampaignVariant& fourth = campaign.variants[5];
  EXPECT_THAT(fourth.overrides,
              ElementsAre("controller.policy=open_loop", "limit.steps=8", "controller.horizon=2"));
  EXPECT_EQ(fourth.resolved.step_limit, 8);
  EXPECT_EQ(fourth.resolved.controller.horizon, 2);
  EXPECT_EQ(fourth.resolved.controller.policy, "open_loop");
  EXPECT_EQ(fourth.resolved.plant.kind, "analytic");
  EXPECT_EQ(campaign.variants[4].resolved.plant.kind, "mujoco");
}

TEST(CampaignFile, names_contain_only_what_differs) {
  const CampaignFolder folder;
  const std::string seeds = "seeds: [0]\n";
  EXPECT_THAT(names_of(folder.load("scenario: dubins_trap\nplants: [analytic, mujoco]\n" + seeds)),
              ElementsAre("analytic", "mujoco"));
  EXPECT_THAT(names_of(folder.load("scenarios: [a.yaml, b.yaml]\n" + seeds)),
              ElementsAre("test", "other"));
  EXPECT_THAT(
      names_of(folder.load("scenario: a.yaml\ngrid: {controller.horizon: [1, 2]}\n" + seeds)),
      ElementsAre("controller.horizon=1", "controller.horizon=2"));
  EXPECT_THAT(
      names_of(folder.load("scenario: a.yaml\nvariants: {only: {}}\nplants: [analytic]\n" + seeds)),
      ElementsAre("only"));
}

TEST(CampaignFile, a_variant_in_a_list_is_named_by_its_settings) {
  const CampaignFolder folder;
  const Campaign campaign = folder.load(
      "scenario: a.yaml\nseeds: [0]\nvariants:\n"
      "  - {}\n"
      "  - {controller.horizon: 12}\n"
      "  - controller.horizon: 3\n    limit: {steps: 5}\n");
  EXPECT_THAT(names_of(campaign), ElementsAre("base", "controller.horizon=12",
                                              "controller.horizon=3, limit={steps: 5}"));
  EXPECT_EQ(campaign.variants[2].resolved.step_limit, 5);
}

TEST(CampaignFile, scenarios_of_the_same_name_are_called_by_their_files) {
  const CampaignFolder folder;
  (void)folder.file("d.yaml", minimal_text);
  EXPECT_THAT(names_of(folder.load("scenarios: [d.yaml, a.yaml, b.yaml]\nseeds: [0]\n")),
              ElementsAre("d", "a", "other"));
}

// As docs/campaign.md states: a single episode can be driven by `qsmpc run`.
TEST(CampaignFile, the_overrides_of_a_variant_reproduce_it) {
  const CampaignFolder folder;
  const Campaign campaign = folder.load(
      "scenario: a.yaml\nseeds: [0]\nplants: [analytic, mujoco_planar]\nvariants:\n"
      "  - initial_state: {mean: [0.5, 0, 1e-3], covariance: [0.01, 0.02, 0]}\n"
      "    description: \"a, b: [c] \\\"d\\\" # \\\\e\"\n"
      "  - safe_set.bounds.x: [-.inf, 20]\n"
      "    safe_set.obstacles: [{x: [2, 3], y: [2, 3]}]\n"
      "    safe_set.obstacles.1: {x: [8, 9]}\n"
      "    description: a plain text, with commas\n"
      "    controller.deadline: 2\n    controller.threads: 2\n");
  ASSERT_EQ(campaign.variants.size(), 4U);
  for (const CampaignVariant& variant : campaign.variants) {
    Scenario again =
        with_plant(load_scenario(folder / variant.scenario, variant.overrides), variant.plant);
    EXPECT_EQ(to_yaml(again), to_yaml(variant.resolved)) << variant.name;
  }
  EXPECT_EQ(campaign.variants[0].resolved.description, "a, b: [c] \"d\" # \\e");
  EXPECT_EQ(campaign.variants[2].resolved.description, "a plain text, with commas");
  EXPECT_EQ(campaign.variants[2].resolved.safe_set.obstacles.size(), 2U);
}

TEST(CampaignFile, what_depends_on_the_machine_is_left_out_unless_it_is_asked_for) {
  const CampaignFolder folder;
  (void)folder.file("a.yaml", minimal_text + "seed: 8\ncontroller: {deadline: 0.1, threads: 2}\n");
  const Campaign campaign = folder.load(
      "scenario: a.yaml\nseeds: [0]\nvariants:\n  plain: {}\n"
      "  own: {controller.deadline: 3, controller.threads: 4}\n"
      "  mapping: {controller: {threads: 5, horizon: 2}}\n");
  const Scenario& plain = campaign.variants[0].resolved;
  EXPECT_EQ(plain.seed, 0U);
  EXPECT_EQ(plain.controller.threads, 1);
  EXPECT_EQ(plain.controller.deadline, kInfinity);
  EXPECT_EQ(campaign.variants[1].resolved.controller.threads, 4);
  EXPECT_EQ(campaign.variants[1].resolved.controller.deadline, 3.0);
  EXPECT_EQ(campaign.variants[2].resolved.controller.threads, 5);
  EXPECT_EQ(campaign.variants[2].resolved.controller.deadline, kInfinity);
}

TEST(CampaignFile, a_scenario_beside_it_comes_before_a_shipped_one_of_that_name) {
  const CampaignFolder folder;
  (void)folder.file("dubins_corridor", minimal_text);
  EXPECT_EQ(folder.load("scenario: dubins_corridor\nseeds: [0]\n").variants[0].resolved.name,
            "test");
  EXPECT_EQ(folder.load("scenario: dubins_trap\nseeds: [0]\n").variants[0].resolved.name,
            "dubins_trap");
}

TEST(CampaignFile, a_plants_file_beside_it_is_found_from_any_working_folder) {
  const CampaignFolder folder;
  const std::string car = content_of(find_mjcf("dubins_planar.xml", ""));
  (void)folder.file("own.xml", car);
  const Campaign campaign = folder.load("scenario: a.yaml\nseeds: [0]\nplants: [own.xml]\n");
  EXPECT_EQ(campaign.variants[0].plant, "own.xml");
  EXPECT_TRUE(
      std::filesystem::equivalent(campaign.variants[0].resolved.plant.mjcf, folder / "own.xml"));
}

TEST(CampaignFile, seeds_reach_to_the_largest_that_a_store_can_hold) {
  const CampaignFolder folder;
  const Campaign campaign =
      folder.load("scenario: a.yaml\nseeds: {first: 9223372036854775806, count: 2}\n");
  EXPECT_EQ(campaign.seeds.at(1), 9223372036854775807U);
}

TEST(CampaignFile, is_distinguished_from_a_scenario_by_its_keys) {
  const CampaignFolder folder;
  EXPECT_FALSE(is_campaign_file(folder / "a.yaml"));
  EXPECT_TRUE(is_campaign_file(folder.campaign("scenario: a.yaml\n")));
  EXPECT_TRUE(is_campaign_file(folder.campaign("seeds: wrong\n")));
  EXPECT_FALSE(is_campaign_file(folder.campaign("seeds: [1]\nmodel: {}\n")));
  EXPECT_FALSE(is_campaign_file(folder.campaign("scenario: [\n")));
  EXPECT_FALSE(is_campaign_file(folder / "none.yaml"));
  EXPECT_FALSE(is_campaign_file("dubins_corridor"));
  EXPECT_TRUE(is_campaign_file("dubins_thousand"));
}

TEST(CampaignFile, an_unknown_name_is_refused_with_the_nearest) {
  try {
    (void)load_campaign("dubins_thousands");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.where().expected, HasSubstr("dubins_thousand (known: "));
  }
}

TEST(ShippedCampaigns, are_valid_described_and_named_as_their_files) {
  const std::vector<ShippedCampaign> shipped = shipped_campaigns();
  EXPECT_GE(shipped.size(), 4U);
  for (const ShippedCampaign& entry : shipped) {
    SCOPED_TRACE(entry.name);
    EXPECT_THAT(validate_campaign_file(entry.name), IsEmpty());
    EXPECT_NE(entry.description, "");
    EXPECT_EQ(load_campaign(entry.name).name, entry.name);
    EXPECT_TRUE(content_of(entry.path).starts_with("# "));
    EXPECT_FALSE(find_shipped_scenario(entry.name)) << "a name of both kinds";
  }
}

TEST(ShippedCampaigns, drive_what_they_say) {
  EXPECT_EQ(load_campaign("dubins_thousand").episodes(), 1000);
  EXPECT_THAT(names_of(load_campaign("dubins_policies")),
              ElementsAre("dubins_corridor / closed", "dubins_corridor / open",
                          "dubins_trap / closed", "dubins_trap / open"));
  EXPECT_THAT(names_of(load_campaign("dubins_plants")),
              ElementsAre("analytic", "mujoco_planar", "mujoco_car"));
  EXPECT_EQ(load_campaign("dubins_solvers").variants[3].resolved.controller.quantisation.state,
            490);
}

}  // namespace campaign_campaign_file_test
}  // namespace qsmpc::harness
