// Invalid campaign files: each is refused with file, line, key, what was found and what is
// expected.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "harness/scenario/shipped_files.hpp"
#include "tests/unit/campaign/campaign_folder.hpp"

namespace qsmpc::harness {
namespace broken_campaign_test {

using ::testing::HasSubstr;
using ::testing::SizeIs;

const std::string two_lines = "scenario: a.yaml\nseeds: [0]\n";  // lines 1 and 2

struct Refusal {
  std::string text;
  int line = 0;
  std::string key;
  std::string found;
  std::string expected;  // a part of it
};

void expect_refused(const Refusal& refusal) {
  SCOPED_TRACE(refusal.text);
  const CampaignFolder folder;
  const InputError::Where where = folder.problem(refusal.text);
  EXPECT_EQ(where.file, "c.yaml");
  EXPECT_EQ(where.line, refusal.line);
  EXPECT_EQ(where.key, refusal.key);
  EXPECT_EQ(where.found, refusal.found);
  EXPECT_THAT(where.expected, HasSubstr(refusal.expected));
}

TEST(BrokenCampaign, keys_of_its_own) {
  expect_refused({two_lines + "variant: {}\n", 3, "variant", "an unknown key", "variants"});
  expect_refused({two_lines + "scenarios: [b.yaml]\n", 3, "scenarios", "both of them", "either"});
  expect_refused({"seeds: [0]\n", 1, "scenario", "nothing", "a shipped scenario"});
  expect_refused({"scenario: a.yaml\n", 1, "seeds", "nothing", "{first: 0, count: 1000}"});
  expect_refused({"scenario: [a.yaml]\nseeds: [0]\n", 1, "scenario", "a list of 1", "path"});
  expect_refused({"scenarios: []\nseeds: [0]\n", 1, "scenarios", "a list of 0", "at least one"});
  expect_refused({two_lines + "name: ''\n", 3, "name", "\"\"", "not empty"});
  expect_refused({two_lines + "traces: some\n", 3, "traces", "some", "none, failures, all"});
  expect_refused({two_lines + "trace_sample: 3\n", 3, "trace_sample", "3", "traces: failures"});
  expect_refused(
      {two_lines + "traces: failures\ntrace_sample: -1\n", 4, "trace_sample", "-1", "from 0"});
  expect_refused({"[a, b]\n", 1, "", "a list of 2", "a mapping"});
}

TEST(BrokenCampaign, rules_that_stop_it) {
  expect_refused({two_lines + "until: {}\n", 3, "until.rate_halfwidth", "nothing", "0.001"});
  expect_refused({two_lines + "until: 0.001\n", 3, "until", "0.001", "a mapping"});
  const std::string until = two_lines + "until:\n  rate_halfwidth: ";
  expect_refused({until + "0\n", 4, "until.rate_halfwidth", "0", "> 0"});
  expect_refused({until + "0.3\n", 4, "until.rate_halfwidth", "0.3", "0.25"});
  expect_refused({until + "0.1\n  confidence: 1\n", 5, "until.confidence", "1", "0.5"});
  expect_refused({until + "0.1\n  of: crash\n", 5, "until.of", "crash", "unsafe, reached"});
  expect_refused({until + "0.1\n  off: reached\n", 5, "until.off", "an unknown key", "of"});
}

TEST(BrokenCampaign, seeds) {
  const std::string head = "scenario: a.yaml\n";
  const std::string whole = "a whole number from 0 to 9223372036854775807";
  expect_refused({head + "seed: 5\n", 2, "seed", "a scenario's key", "seeds: {first: 0"});
  expect_refused({head + "seeds: 100\n", 2, "seeds", "100", "{first: 0, count: 1000}"});
  expect_refused({head + "seeds: []\n", 2, "seeds", "a list of 0", "1 to 100000"});
  expect_refused({head + "seeds: [1, 2, 1]\n", 2, "seeds.2", "1 a second time", "once"});
  expect_refused({head + "seeds: [1, -2]\n", 2, "seeds.1", "-2", whole});
  expect_refused({head + "seeds: ['1']\n", 2, "seeds.0", "\"1\"", whole});
  expect_refused(
      {head + "seeds: [9223372036854775808]\n", 2, "seeds.0", "9223372036854775808", whole});
  expect_refused({head + "seeds: {first: 1}\n", 2, "seeds.count", "nothing", "how many"});
  expect_refused({head + "seeds:\n  count: 0\n", 3, "seeds.count", "0", "from 1 to 1000000000"});
  expect_refused({head + "seeds: {count: 1000000001}\n", 2, "seeds.count", "1000000001",
                  "from 1 to 1000000000"});
  expect_refused({head + "seeds: {count: 1, first: 0.5}\n", 2, "seeds.first", "0.5", whole});
  expect_refused({head + "seeds:\n  count: 2\n  first: 9223372036854775807\n", 4, "seeds.first",
                  "9223372036854775807 with a count of 2", "no seed above 9223372036854775807"});
  expect_refused(
      {head + "seeds: {count: 1, last: 3}\n", 2, "seeds.last", "an unknown key", "count"});
}

TEST(BrokenCampaign, variants_and_grid) {
  expect_refused({two_lines + "variants: fast\n", 3, "variants", "fast", "a mapping of names"});
  expect_refused({two_lines + "variants: {}\n", 3, "variants", "a mapping", "a mapping of names"});
  expect_refused({two_lines + "variants:\n  fast:\n", 4, "variants.fast", "nothing", "{} for"});
  expect_refused({two_lines + "variants: [3]\n", 3, "variants.0", "3", "{} for"});
  expect_refused({two_lines + "variants: {'': {}}\n", 3, "variants", "\"\"", "a name of 1 to"});
  expect_refused({two_lines + "variants: [{}, {}]\n", 3, "variants.1",
                  "a second variant called base", "differ"});
  expect_refused({two_lines + "grid: [1]\n", 3, "grid", "a list of 1", "a mapping of keys"});
  expect_refused({two_lines + "grid: {controller.horizon: 3}\n", 3, "grid.controller.horizon", "3",
                  "a list of at least one"});
  expect_refused({two_lines + "grid: {controller.horizon: []}\n", 3, "grid.controller.horizon",
                  "a list of 0", "a list of at least one"});
  expect_refused({two_lines + "grid:\n  controller.horizon:\n    - 3\n    - 3\n", 6,
                  "grid.controller.horizon.1", "3 a second time", "once"});
  expect_refused(
      {two_lines + "variants: {a: {seed: 3}}\n", 3, "variants.a.seed", "a seed", "seeds"});
  expect_refused({two_lines + "grid: {name: [a]}\n", 3, "grid.name", "a name", "names from"});
  expect_refused({two_lines + "grid: {'a=b': [1]}\n", 3, "grid.a=b", "\"a=b\"", "joined by dots"});
}

TEST(BrokenCampaign, a_key_that_would_undo_another) {
  const std::string found = "controller.horizon a second time, or after a key within it";
  expect_refused({two_lines + "variants:\n  a: {controller.horizon: 3}\n" +
                      "grid:\n  limit.steps: [4]\n  controller.horizon: [5]\n",
                  7, "grid.controller.horizon", found, "once"});
  expect_refused({two_lines + "variants: {a: {controller.horizon: 3, controller: {horizon: 2}}}\n",
                  3, "variants.a.controller", "controller a second time, or after a key within it",
                  "once"});
  // The reverse order is valid: a mapping, then a key within it.
  const CampaignFolder folder;
  const Campaign campaign = folder.load(
      two_lines + "variants: {a: {controller: {horizon: 2}}}\ngrid: {controller.horizon: [5]}\n");
  EXPECT_EQ(campaign.variants[0].resolved.controller.horizon, 5);
}

TEST(BrokenCampaign, a_wrong_setting_is_at_its_key_in_the_campaign) {
  const std::string horizon = "a whole number from 1 to 1000";
  expect_refused({two_lines + "variants:\n  base: {}\n  fast:\n    controller.horizon: 0\n", 6,
                  "variants.fast.controller.horizon", "0", horizon});
  expect_refused({two_lines + "variants: [{controller: {horizon: 0}}]\n", 3,
                  "variants.0.controller.horizon", "0", horizon});
  expect_refused({two_lines + "grid:\n  controller.horizon: [3, 0]\n", 4,
                  "grid.controller.horizon.1", "0", horizon});
  expect_refused({two_lines + "grid:\n  controller: [{}, {horizon: 0}]\n", 4,
                  "grid.controller.1.horizon", "0", horizon});
  expect_refused({two_lines + "variants: {a: {controler.horizon: 3}}\n", 3, "variants.a.controler",
                  "an unknown key", "controller"});
  expect_refused({two_lines + "variants: {a: {controller.horizn: 3}}\n", 3,
                  "variants.a.controller.horizn", "an unknown key", "horizon"});
  expect_refused({two_lines + "variants: {a: {name.first: 3}}\n", 3, "variants.a.name.first",
                  "a name", "names"});
  expect_refused({two_lines + "variants: {a: {time_step.b: 3}}\n", 3, "variants.a.time_step",
                  "a mapping", "a number"});
  expect_refused({two_lines + "variants: {a: {controller..horizon: 3}}\n", 3,
                  "variants.a.controller..horizon", "an empty part of a key", "names joined"});
}

TEST(BrokenCampaign, a_setting_that_breaks_another_value_of_the_scenario_is_named) {
  expect_refused(
      {two_lines + "variants:\n  a:\n    limit.steps: 3\n    safe_set.bounds.x: [1, 9]\n" +
           "    controller.horizon: 2\n",
       6, "variants.a.safe_set.bounds.x",
       "with this setting, initial_state.mean: x = 0, outside of the bounds 1 < x < 9", ""});
}

TEST(BrokenCampaign, every_wrong_value_is_reported_once_by_validation) {
  const CampaignFolder folder;
  const auto problems = folder.problems(
      "scenarios: [a.yaml, b.yaml]\nseeds: {}\n"
      "variants:\n  a: {controller.horizon: 0, limit.steps: 0}\n  b: {controller.policy: none}\n"
      "grid: {time_step: [0.1, 0.2, -1]}\n");
  std::vector<std::string> keys;
  keys.reserve(problems.size());
  for (const InputError::Where& where : problems) keys.push_back(where.key);
  EXPECT_THAT(keys, ::testing::ElementsAre("seeds.count", "variants.a.limit.steps",
                                           "variants.a.controller.horizon",
                                           "variants.b.controller.policy", "grid.time_step.2"));
}

TEST(BrokenCampaign, a_broken_scenario_is_named_itself) {
  const CampaignFolder folder;
  (void)folder.file("a.yaml", minimal_text + "controller: {horizon: 0}\n");
  const InputError::Where where =
      folder.problem(two_lines + "variants: {a: {limit.steps: 3}, b: {}}\n");
  EXPECT_EQ(where.file, "a.yaml");
  EXPECT_EQ(where.line, 6);
  EXPECT_EQ(where.key, "controller.horizon");
}

TEST(BrokenCampaign, a_scenario_that_is_not_there) {
  const CampaignFolder folder;
  const InputError::Where where =
      folder.problem("scenarios:\n  - a.yaml\n  - dubins_corridr\nseeds: [0]\n");
  EXPECT_EQ(where.file, "c.yaml");
  EXPECT_EQ(where.line, 3);
  EXPECT_EQ(where.key, "scenarios.1");
  EXPECT_EQ(where.found, "dubins_corridr");
  EXPECT_THAT(where.expected, HasSubstr("dubins_corridor (known"));
}

TEST(BrokenCampaign, scenarios_that_cannot_be_told_apart) {
  expect_refused({"scenarios: [a.yaml, ./a.yaml]\nseeds: [0]\n", 1, "scenarios.1",
                  "a second scenario called a", "differ"});
  expect_refused({"scenarios: [a.yaml, a.yaml]\nseeds: [0]\n", 1, "scenarios.1",
                  "a.yaml a second time", "once"});
}

TEST(BrokenCampaign, names_that_their_separator_makes_equal) {
  const CampaignFolder folder;
  (void)folder.file("d.yaml", "name: test / x\n" + minimal_text.substr(11));
  const InputError::Where where =
      folder.problem("scenarios: [a.yaml, d.yaml]\nseeds: [0]\nvariants: {x / y: {}, y: {}}\n");
  EXPECT_EQ(where.found, "two variants called test / x / y");
}

TEST(BrokenCampaign, plants) {
  expect_refused({two_lines + "plants: []\n", 3, "plants", "a list of 0", "at least one"});
  expect_refused(
      {two_lines + "plants: [analytic, mujoco_cat]\n", 3, "plants.1", "mujoco_cat", "mujoco_car"});
  expect_refused({two_lines + "plants: [analytic, analytic]\n", 3, "plants.1",
                  "analytic a second time", "once"});
  expect_refused({"scenarios: [a.yaml, double_integrator]\nseeds: [0]\nplants: [mujoco_car]\n", 3,
                  "plants.0", "mujoco_car, for double_integrator", "mujoco_slider"});
}

TEST(BrokenCampaign, a_plant_that_cannot_be_made_is_refused_before_anything_runs) {
  const CampaignFolder folder;
  (void)folder.file("broken.xml", "<mujoco><worldbody></mujoco>");
  const InputError::Where named =
      folder.problem(two_lines + "plants:\n  - analytic\n  - broken.xml\n");
  EXPECT_EQ(named.file, "c.yaml");
  EXPECT_EQ(named.line, 5);
  EXPECT_EQ(named.key, "plants.1");
  EXPECT_THAT(named.found, HasSubstr("broken.xml: "));

  const InputError::Where set =
      folder.problem(two_lines + "variants:\n  a: {plant.mjcf: broken.xml, plant.kind: mujoco}\n");
  EXPECT_EQ(set.line, 4);
  EXPECT_EQ(set.key, "variants.a.plant.mjcf");

  (void)folder.file("a.yaml", minimal_text + "disturbance: {mass: 0.1}\n");
  const InputError::Where own = folder.problem(two_lines);
  EXPECT_EQ(own.line, 1);
  EXPECT_EQ(own.key, "scenario");
  EXPECT_THAT(own.found, HasSubstr("disturbance.mass: "));
}

// Instantly and with little memory, not after enumerating ten billion variants.
TEST(HostileCampaign, a_huge_grid_is_refused_by_its_size) {
  const CampaignFolder folder;
  std::string text = two_lines + "grid:\n";
  for (int i = 0; i < 10; ++i) {
    text += "  k" + std::to_string(i) + ": [0, 1, 2, 3, 4, 5, 6, 7, 8, 9]\n";
  }
  const InputError::Where where = folder.problem(text);
  EXPECT_EQ(where.line, 4);
  EXPECT_EQ(where.key, "grid");
  EXPECT_THAT(where.found, HasSubstr("= 10000000000 variants"));
  EXPECT_EQ(where.expected, "at most 10000");
  for (int i = 10; i < 2000; ++i) text += "  k" + std::to_string(i) + ": [0, 1, 2, 3, 4, 5]\n";
  EXPECT_THAT(folder.problem(text).found, HasSubstr("= over 1000000000000000 variants"));
}

TEST(HostileCampaign, long_values_in_many_variants_are_refused_by_their_size) {
  const CampaignFolder folder;
  std::string text =
      two_lines + "variants: {a: {description: " + std::string(500'000, 'x') + "}}\n";
  text += "grid: {controller.horizon: [";
  for (int i = 1; i <= 100; ++i) text += std::to_string(i) + ",";
  EXPECT_THAT(folder.problem(text + "]}\n").expected, HasSubstr("16777216 bytes"));
}

TEST(HostileCampaign, a_campaign_is_not_a_scenario_of_itself) {
  const CampaignFolder folder;
  const auto problems = folder.problems("scenario: c.yaml\nseeds: [0]\n");
  std::vector<std::string> keys;
  for (const InputError::Where& where : problems) {
    EXPECT_EQ(where.file, "c.yaml");
    keys.push_back(where.key + ", " + where.found);
  }
  EXPECT_THAT(keys, ::testing::IsSupersetOf({"scenario, an unknown key", "name, nothing"}));
}

TEST(HostileCampaign, what_is_not_yaml_is_refused_in_one_line) {
  const CampaignFolder folder;
  EXPECT_THAT(folder.problem("scenario: [\n").found, HasSubstr("not YAML"));
  EXPECT_THAT(folder.problem("").found, HasSubstr("empty"));
  EXPECT_THAT(folder.problem("a: &x 1\n").found, HasSubstr("anchor"));
  EXPECT_THAT(folder.problem(std::string(2'000'000, 'x')).expected, HasSubstr("1 MiB"));
  EXPECT_THAT(folder.problem("seeds: " + std::string(20, '[') + std::string(20, ']')).found,
              HasSubstr("deeper"));
  EXPECT_THAT(validate_campaign_file(folder / "none.yaml"), SizeIs(1));
  EXPECT_THAT(validate_campaign_file(folder.path()), SizeIs(1));
}

TEST(HostileCampaign, many_wrong_variants_give_a_bounded_number_of_problems) {
  const CampaignFolder folder;
  std::string text = two_lines + "variants:\n";
  for (int i = 0; i < 9000; ++i) {
    text += "  v" + std::to_string(i) + ": {controller.horizon: 0}\n";
  }
  EXPECT_THAT(folder.problems(text), SizeIs(100));
}

}  // namespace broken_campaign_test
}  // namespace qsmpc::harness
