// The drives that a contest requires.
#include "harness/contest/contest_plan.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/unit/contest/contest_fixture.hpp"

namespace qsmpc::harness {
namespace contest_plan_test {

using testing::contest_text;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

TEST(ContestPlan, places_every_controller_in_every_cell) {
  const testing::ContestFolder folder;
  const LoadedContest loaded = folder.load(
      "controllers: {a: {}, b: {controller.kind: lqr}}\n"
      "scenarios: [quick.yaml, dubins_corridor]\nplants: [analytic, mujoco_car]\n"
      "noise: [1, 3]\nseeds: [1, 2]\n");
  const Contest& contest = loaded.contest;
  ASSERT_EQ(loaded.drives.variants.size(), 16U);
  EXPECT_EQ(loaded.drives.episodes(), 32);
  for (const ContestCell& cell : contest.cells()) {
    for (std::size_t n = 0; n < 2; ++n) {
      const CampaignVariant& variant = loaded.drives.variants[variant_of(contest, 2, n, cell)];
      EXPECT_EQ(variant.scenario, contest.scenarios[cell.scenario].text);
      EXPECT_EQ(variant.plant, contest.plants[cell.plant].text);
      EXPECT_EQ(variant.settings,
                contest.controllers[n].name + (cell.noise == 0 ? ", noise=1" : ", noise=3"));
      EXPECT_EQ(variant.resolved.controller.kind, n == 0 ? "quantised" : "lqr");
    }
  }
  EXPECT_EQ(loaded.drives.variants[2].name, "quick / a, noise=3 / analytic");
  EXPECT_EQ(contest.name_of(contest.cells()[7]), "dubins_corridor, mujoco_car, noise 3");
}

TEST(ContestPlan, noise_scales_the_covariance_that_the_controllers_receive) {
  const testing::ContestFolder folder;
  const LoadedContest loaded = folder.load(contest_text("noise: [0, 1, 2.5]\n"));
  const Eigen::MatrixXd own = testing::quick_scenario().disturbance.covariance;
  const std::vector<double> factors = {0.0, 1.0, 2.5};
  for (std::size_t n = 0; n < 3; ++n) {
    EXPECT_EQ(loaded.drives.variants[n].resolved.disturbance.covariance, factors[n] * own);
  }
  EXPECT_TRUE(loaded.drives.variants[1].overrides.size() == 1U)
      << "the scenario's needs no setting";
  EXPECT_THAT(
      loaded.drives.variants[2].overrides,
      ElementsAre("controller.kind=quantised", "disturbance.covariance=[0.025, 0.025, 0.0025]"));
}

TEST(ContestPlan, noise_of_a_map_without_any_is_refused) {
  const testing::ContestFolder folder;
  EXPECT_THAT(folder.problems(contest_text("noise: [1, 2]\ncommon: {disturbance: {}}\n")),
              HasSubstr("small.yaml:6: noise.1: found a factor of 2 for quick.yaml, which has no "
                        "disturbance"));
}

TEST(ContestPlan, says_what_would_be_driven) {
  const testing::ContestFolder folder;
  const LoadedContest loaded = folder.load(contest_text(
      "tuning: {seeds: [1], budget: 1, search: {bold: {controller.max_iterations: [3, 4]}}}\n"));
  EXPECT_EQ(contest_size_text(loaded),
            "contest small: 2 controllers x 1 scenario x 1 plant x 1 noise level x 3 seeds = 6 "
            "drives");
  EXPECT_THAT(contest_plan_text(loaded), HasSubstr("1 of 2 candidates are tried"));
  const auto json = nlohmann::json::parse(contest_plan_json(loaded));
  EXPECT_EQ(json["reference"], "careful");
  EXPECT_EQ(json["controllers"]["bold"]["grid"], 2);
  EXPECT_EQ(json["drives"]["episodes"], 6);
  EXPECT_EQ(json["search"], nullptr) << "one candidate is no choice";
}

TEST(ContestPlan, first_seeds_are_those_that_come_first) {
  EXPECT_EQ(first_seeds({.first = 4, .count = 9}, 2), (SeedSet{.first = 4, .count = 2}));
  EXPECT_EQ(first_seeds({.first = 4, .count = 1}, 2), (SeedSet{.first = 4, .count = 1}));
  EXPECT_THAT(first_seeds({.listed = {7, 3, 9}}, 2).listed, ElementsAre(7, 3));
}

}  // namespace contest_plan_test
}  // namespace qsmpc::harness
