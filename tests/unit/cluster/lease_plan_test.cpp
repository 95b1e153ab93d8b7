#include "harness/cluster/lease_plan.hpp"

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "harness/errors.hpp"
#include "harness/files/atomic_file.hpp"
#include "harness/files/text_file.hpp"
#include "harness/scenario/scenario_file.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/unit/campaign/campaign_fixture.hpp"

namespace qsmpc::harness {
namespace lease_plan_test {

using ::testing::HasSubstr;
using testing::TemporaryFolder;

Campaign example_campaign() {
  Campaign campaign = testing::quick_campaign(7);
  campaign.traces = TraceKeeping::kFailures;
  campaign.trace_sample = 3;
  campaign.variants[1].overrides = {"controller.horizon=2"};
  campaign.risk_against_cost = {{.name = "both", .settings = {"three", "two"}}};
  return campaign;
}

TEST(LeasePlan, holds_the_campaign_as_it_was) {
  const TemporaryFolder folder;
  const Campaign campaign = example_campaign();
  write_lease_plan(lease_plan(campaign, 3), folder.path());
  const LeasePlan plan = read_lease_plan(folder.path());
  EXPECT_EQ(plan.leases(), 3);
  EXPECT_EQ(plan.seeds_of(0), 3);
  EXPECT_EQ(plan.seeds_of(2), 1);
  EXPECT_EQ(plan.episodes(), 14);
  const Campaign planned = planned_campaign(plan, folder.path());
  EXPECT_EQ(planned.name, campaign.name);
  EXPECT_EQ(planned.seeds, campaign.seeds);
  EXPECT_EQ(planned.traces, campaign.traces);
  EXPECT_EQ(planned.trace_sample, campaign.trace_sample);
  EXPECT_EQ(planned.risk_against_cost, campaign.risk_against_cost);
  ASSERT_EQ(planned.variants.size(), campaign.variants.size());
  for (std::size_t n = 0; n < campaign.variants.size(); ++n) {
    EXPECT_EQ(planned.variants[n].name, campaign.variants[n].name);
    EXPECT_EQ(planned.variants[n].overrides, campaign.variants[n].overrides);
    EXPECT_EQ(to_yaml(planned.variants[n].resolved), to_yaml(campaign.variants[n].resolved));
  }
}

TEST(LeasePlan, holds_seeds_that_are_listed) {
  const TemporaryFolder folder;
  Campaign campaign = example_campaign();
  campaign.seeds = {.listed = {9, 2, 5}};
  write_lease_plan(lease_plan(campaign, 2), folder.path());
  EXPECT_EQ(read_lease_plan(folder.path()).seeds, campaign.seeds);
}

/// The error message for a plan altered by `change`.
std::string refusal_after(const std::function<void(nlohmann::ordered_json&)>& change) {
  const TemporaryFolder folder;
  write_lease_plan(lease_plan(example_campaign(), 3), folder.path());
  const std::string path = cluster_path(folder.path(), kPlanFile);
  auto json = nlohmann::ordered_json::parse(read_text_file(path));
  change(json);
  write_file(path, json.dump());
  try {
    (void)planned_campaign(read_lease_plan(folder.path()), folder.path());
  } catch (const InputError& error) {
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
    return error.what();
  }
  return "not refused";
}

TEST(LeasePlan, is_refused_by_another_version_and_where_vehicles_differ) {
  EXPECT_EQ(refusal_after([](auto&) {}), "not refused");
  EXPECT_THAT(refusal_after([](auto& json) { json["version"] = "77.1"; }), HasSubstr("qsmpc 77.1"));
  EXPECT_THAT(refusal_after([](auto& json) { json["variants"][1]["plant_digest"] = "0123"; }),
              HasSubstr("variant two: found a vehicle with the digest 0123"));
  EXPECT_THAT(refusal_after([](auto& json) { json["format"] = 99; }), HasSubstr("format 99"));
  EXPECT_THAT(refusal_after([](auto& json) { json.erase("seeds"); }), HasSubstr("seeds"));
  EXPECT_THAT(refusal_after([](auto& json) { json["lease_seeds"] = 0; }), HasSubstr("lease_seeds"));
}

TEST(LeasePlan, has_leases_that_keep_all_busy_to_the_end_and_no_more_than_a_folder_holds) {
  EXPECT_EQ(default_lease_seeds(10, 80), 1);
  EXPECT_EQ(default_lease_seeds(6400, 20), 20);
  EXPECT_EQ(default_lease_seeds(100'000, 4), 64);
  const std::int64_t many = 1'000'000'000;
  EXPECT_LE(many / default_lease_seeds(many, 4), kMostLeases);
  Campaign campaign = testing::quick_campaign(many);
  EXPECT_THROW((void)lease_plan(campaign, 1), InputError);
}

}  // namespace lease_plan_test
}  // namespace qsmpc::harness
