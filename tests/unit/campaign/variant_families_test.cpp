// The key `figure` of campaign files: what it selects, and what is refused.
#include "harness/campaign/plan/variant_families.hpp"

#include <random>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/campaign/campaign_folder.hpp"

namespace qsmpc::harness {
namespace variant_families_test {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

// Lines 1 to 4.
const std::string four_lines =
    "scenarios: [a.yaml, b.yaml]\nseeds: [0]\n"
    "variants: {w2: {controller.horizon: 2}, w20: {controller.horizon: 3}, r1: {}}\nfigure:\n";

void expect_refused(const std::string& text, const InputError::Where& expected) {
  SCOPED_TRACE(text);
  const CampaignFolder folder;
  const InputError::Where where = folder.problem(text);
  EXPECT_EQ(where.file, "c.yaml");
  EXPECT_EQ(where.line, expected.line);
  EXPECT_EQ(where.key, expected.key);
  EXPECT_EQ(where.found, expected.found);
  EXPECT_THAT(where.expected, HasSubstr(expected.expected));
}

TEST(VariantFamilies, are_lists_of_variants_in_the_order_of_the_file) {
  const CampaignFolder folder;
  const Campaign campaign =
      folder.load(four_lines + "  risk_against_cost: {penalties: [w20, w2], limits: [r1, w2]}\n");
  EXPECT_THAT(campaign.risk_against_cost,
              ElementsAre(VariantFamily{.name = "penalties", .settings = {"w20", "w2"}},
                          VariantFamily{.name = "limits", .settings = {"r1", "w2"}}));
}

TEST(VariantFamilies, hold_points_of_a_grid_by_their_settings) {
  const CampaignFolder folder;
  const Campaign campaign = folder.load(
      "scenario: a.yaml\nseeds: [0]\ngrid: {controller.horizon: [2, 3]}\n"
      "figure: {risk_against_cost: {horizon: [controller.horizon=3, controller.horizon=2]}}\n");
  ASSERT_EQ(campaign.risk_against_cost.size(), 1U);
  EXPECT_EQ(campaign.risk_against_cost[0].settings[0], campaign.variants[1].settings);
  EXPECT_EQ(campaign.risk_against_cost[0].settings[1], campaign.variants[0].settings);
}

TEST(VariantFamilies, there_are_none_without_the_key) {
  const CampaignFolder folder;
  EXPECT_THAT(folder.load("scenario: a.yaml\nseeds: [0]\n").risk_against_cost, IsEmpty());
  EXPECT_THAT(folder.load("scenario: a.yaml\nseeds: [0]\nfigure: {}\n").risk_against_cost,
              IsEmpty());
}

TEST(VariantFamilies, a_variant_that_is_not_there_is_refused_with_what_is) {
  expect_refused(four_lines + "  risk_against_cost:\n    penalties: [w2]\n    limits: [r1, w200]\n",
                 {.line = 7,
                  .key = "figure.risk_against_cost.limits.1",
                  .found = "w200",
                  .expected = "(known: w2, w20, r1)"});
  expect_refused("scenario: a.yaml\nseeds: [0]\nfigure: {risk_against_cost: {all: [base]}}\n",
                 {.line = 3,
                  .key = "figure.risk_against_cost.all.0",
                  .found = "base",
                  .expected = "no variants or grid"});
}

TEST(VariantFamilies, of_very_many_variants_some_are_listed) {
  std::string values = "1";
  for (int n = 2; n <= 200; ++n) values += fmt::format(", {}", n);
  const CampaignFolder folder;
  const InputError::Where where =
      folder.problem("scenario: a.yaml\nseeds: [0]\ngrid: {controller.horizon: [" + values +
                     "]}\nfigure: {risk_against_cost: {all: [controller.horizn=150]}}\n");
  EXPECT_THAT(where.expected,
              AllOf(HasSubstr("controller.horizon=150"), HasSubstr("controller.horizon=9"),
                    Not(HasSubstr("controller.horizon=90")), EndsWith("…")));
}

TEST(VariantFamilies, a_variant_is_once_in_a_family) {
  expect_refused(four_lines + "  risk_against_cost:\n    all: [w2, r1, w2]\n",
                 {.line = 6,
                  .key = "figure.risk_against_cost.all.2",
                  .found = "w2 a second time",
                  .expected = "each once"});
}

TEST(VariantFamilies, what_is_not_a_mapping_of_names_to_lists_is_refused) {
  const std::string key = "figure.risk_against_cost";
  expect_refused(
      four_lines + "  risk_against_cost: [w2]\n",
      {.line = 5, .key = key, .found = "a list of 1", .expected = "a mapping of 1 to 6"});
  expect_refused(four_lines + "  risk_against_cost: {}\n",
                 {.line = 5, .key = key, .found = "a mapping", .expected = "a mapping of 1 to 6"});
  expect_refused(
      four_lines + "  risk_against_cost: {a: w2}\n",
      {.line = 5, .key = key + ".a", .found = "w2", .expected = "a list of at least one variant"});
  expect_refused(
      four_lines + "  risk_against_cost: {a: []}\n",
      {.line = 5, .key = key + ".a", .found = "a list of 0", .expected = "at least one"});
  expect_refused(four_lines + "  risk_against_cost: {a: [{w2: 1}]}\n",
                 {.line = 5, .key = key + ".a.0", .found = "a mapping", .expected = "the name of"});
  expect_refused(four_lines + "  risk_against_cost: {'': [w2]}\n",
                 {.line = 5, .key = key, .found = "\"\"", .expected = "a name of 1 to 100 bytes"});
  std::string seven;
  for (int n = 0; n < 7; ++n) seven += fmt::format("    f{}: [w2]\n", n);
  expect_refused(four_lines + "  risk_against_cost:\n" + seven,
                 {.line = 5, .key = key, .found = "a mapping", .expected = "1 to 6"});
}

TEST(VariantFamilies, other_figures_are_refused) {
  expect_refused(four_lines + "  cost_against_risk: {a: [w2]}\n",
                 {.line = 5,
                  .key = "figure.cost_against_risk",
                  .found = "an unknown key",
                  .expected = "risk_against_cost"});
  expect_refused(
      "scenario: a.yaml\nseeds: [0]\nfigure: risk_against_cost\n",
      {.line = 3, .key = "figure", .found = "risk_against_cost", .expected = "a mapping"});
}

TEST(VariantFamilies, damaged_ones_are_loaded_or_refused_and_nothing_else) {
  const std::string whole = "  risk_against_cost: {penalties: [w20, w2], limits: [r1, w2]}\n";
  const std::string syntax = "[]{}:,-#&*!|>'\"%@`\n\t .0123456789eE+~?\\=";
  const CampaignFolder folder;
  std::mt19937_64 random(7);
  int refused = 0;
  for (int i = 0; i < 100; ++i) {
    std::string text = whole;
    text[random() % text.size()] = syntax[random() % syntax.size()];
    try {
      (void)folder.load(four_lines + text);
    } catch (const InputError& error) {
      EXPECT_NE(error.where().expected, "") << error.what() << "\n" << text;
      ++refused;
    }
  }
  EXPECT_GT(refused, 50) << "or the damage is too mild to test anything";
}

}  // namespace variant_families_test
}  // namespace qsmpc::harness
