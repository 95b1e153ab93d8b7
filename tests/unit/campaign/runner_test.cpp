#include "harness/campaign/runner.hpp"

#include <algorithm>
#include <atomic>
#include <filesystem>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "harness/campaign/store/folder_lock.hpp"
#include "harness/errors.hpp"
#include "harness/trace/trace_file.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/unit/campaign/campaign_fixture.hpp"

namespace qsmpc::harness {
namespace runner_test {

namespace fs = std::filesystem;
using testing::quick_campaign;
using testing::TemporaryFolder;

/// All rows with their periods, without wall-clock values.
std::vector<EpisodeRow> rows_in(const std::string& folder) {
  const StoreReader store(folder);
  std::vector<EpisodeRow> rows;
  for (const StoredVariant& variant : store.variants()) {
    const std::size_t begin = rows.size();
    store.for_each_episode(variant.id, [&](const EpisodeRow& row) {
      rows.push_back(row);
      rows.back().timing = {};
    });
    store.for_each_period(variant.id, [&](std::uint64_t seed, std::int64_t, PeriodRow period) {
      period.ocp_ms = 0.0;
      std::ranges::find(rows.begin() + static_cast<std::ptrdiff_t>(begin), rows.end(), seed,
                        &EpisodeRow::seed)
          ->periods.push_back(period);
    });
  }
  return rows;
}

std::vector<std::uint64_t> seeds_in(const std::string& folder) {
  std::vector<std::uint64_t> seeds;
  StoreReader(folder).for_each_episode(0,
                                       [&](const EpisodeRow& row) { seeds.push_back(row.seed); });
  return seeds;
}

TEST(CampaignRunner, drives_every_variant_with_every_seed) {
  const TemporaryFolder folder;
  const CampaignProgress end = run_campaign(testing::quick_campaign(), folder.path(), {});
  EXPECT_EQ(end.total, 8);
  EXPECT_EQ(end.done, 8);
  EXPECT_EQ(end.fresh, 8);
  const std::vector<EpisodeRow> rows = rows_in(folder.path());
  ASSERT_EQ(rows.size(), 8U);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    EXPECT_EQ(rows[i].variant, static_cast<std::int64_t>(i / 4));
    EXPECT_EQ(rows[i].seed, 5 + i % 4);
    EXPECT_EQ(rows[i].periods.size(), static_cast<std::size_t>(rows[i].steps));
  }
}

TEST(CampaignRunner, rows_do_not_depend_on_the_number_of_jobs) {
  const TemporaryFolder one;
  const TemporaryFolder three;
  (void)run_campaign(testing::quick_campaign(6), one.path(), {.jobs = 1});
  (void)run_campaign(testing::quick_campaign(6), three.path(), {.jobs = 3});
  EXPECT_EQ(rows_in(one.path()), rows_in(three.path()));
}

TEST(CampaignRunner, gives_the_variants_of_a_seed_the_same_random_numbers) {
  const TemporaryFolder folder;
  Campaign campaign = testing::quick_campaign(3);
  campaign.variants[1].resolved = campaign.variants[0].resolved;
  (void)run_campaign(campaign, folder.path(), {});
  int pairs = 0;
  StoreReader(folder.path()).for_each_pair(0, 1, [&](const EpisodeRow& a, const EpisodeRow& b) {
    EXPECT_EQ(a.cost, b.cost);
    ++pairs;
  });
  EXPECT_EQ(pairs, 3);
}

TEST(CampaignRunner, resumes_where_it_was_stopped) {
  const TemporaryFolder stopped;
  const TemporaryFolder whole;
  std::atomic<int> episodes = 0;
  CampaignOptions options;
  options.on_progress = [&](const CampaignProgress& progress) {
    episodes = static_cast<int>(progress.fresh);
  };
  options.should_stop = [&] { return episodes >= 3; };
  EXPECT_EQ(run_campaign(testing::quick_campaign(), stopped.path(), options).done, 3);
  const CampaignProgress end = run_campaign(testing::quick_campaign(), stopped.path(), {});
  EXPECT_EQ(end.done, 8);
  EXPECT_EQ(end.fresh, 5);
  (void)run_campaign(testing::quick_campaign(), whole.path(), {});
  EXPECT_EQ(rows_in(stopped.path()), rows_in(whole.path()));
}

TEST(CampaignRunner, an_episode_that_is_given_up_is_not_stored) {
  const TemporaryFolder folder;
  CampaignOptions options;
  options.should_hurry = [] { return true; };
  std::atomic<int> asked = 0;
  options.should_stop = [&] { return asked++ > 0; };
  EXPECT_EQ(run_campaign(testing::quick_campaign(), folder.path(), options).done, 0);
}

/// A rule that stops well before the last of its seeds.
Campaign early_campaign() {
  Campaign campaign = testing::quick_campaign(40);
  campaign.traces = TraceKeeping::kAll;
  campaign.until = {.of = "unsafe", .rate_halfwidth = 0.25, .confidence = 0.6};
  return campaign;
}

TEST(CampaignRunner, stops_early_after_the_same_seeds_for_any_number_of_jobs) {
  const TemporaryFolder one;
  const TemporaryFolder three;
  const CampaignProgress first = run_campaign(early_campaign(), one.path(), {.jobs = 1});
  const CampaignProgress second = run_campaign(early_campaign(), three.path(), {.jobs = 3});
  ASSERT_TRUE(first.stopped_after);
  EXPECT_GT(*first.stopped_after, 1);
  EXPECT_LT(*first.stopped_after, 40);
  EXPECT_EQ(first.stopped_after, second.stopped_after);
  EXPECT_EQ(first.done, 2 * *first.stopped_after);
  EXPECT_EQ(first.total, first.done);
  EXPECT_EQ(second.done, first.done);
  EXPECT_EQ(rows_in(one.path()), rows_in(three.path()));
  const StoreReader store(three.path());
  EXPECT_EQ(store.campaign().stopped_after, first.stopped_after);
  EXPECT_EQ(store.campaign().episodes, first.done);
}

TEST(CampaignRunner, stops_early_after_the_same_seeds_when_it_was_interrupted) {
  const TemporaryFolder whole;
  const TemporaryFolder stopped;
  std::atomic<int> episodes = 0;
  CampaignOptions options{.jobs = 3};
  options.on_progress = [&](const CampaignProgress& progress) {
    episodes = static_cast<int>(progress.fresh);
  };
  options.should_stop = [&] { return episodes >= 3; };
  EXPECT_FALSE(run_campaign(early_campaign(), stopped.path(), options).stopped_after);
  const CampaignProgress end = run_campaign(early_campaign(), stopped.path(), {.jobs = 2});
  (void)run_campaign(early_campaign(), whole.path(), {});
  EXPECT_EQ(rows_in(stopped.path()), rows_in(whole.path()));
  // A restart has nothing to do.
  const CampaignProgress again = run_campaign(early_campaign(), stopped.path(), {});
  EXPECT_EQ(again.fresh, 0);
  EXPECT_EQ(again.stopped_after, end.stopped_after);
}

TEST(CampaignRunner, removes_what_was_driven_beyond_the_seeds_that_suffice) {
  const TemporaryFolder folder;
  Campaign campaign = early_campaign();
  campaign.until.reset();
  (void)run_campaign(campaign, folder.path(), {});
  ASSERT_EQ(rows_in(folder.path()).size(), 80U);
  const CampaignProgress end = run_campaign(early_campaign(), folder.path(), {.update = true});
  ASSERT_TRUE(end.stopped_after);
  EXPECT_EQ(end.fresh, 0);
  const auto suffice = static_cast<std::uint64_t>(*end.stopped_after);
  for (const std::uint64_t seed : seeds_in(folder.path())) EXPECT_LT(seed, 5U + suffice);
  EXPECT_EQ(rows_in(folder.path()).size(), 2U * suffice);
  for (const std::uint64_t seed : {5 + suffice - 1, 5 + suffice}) {
    EXPECT_EQ(std::filesystem::exists(folder.path() + "/" + episode_folder(0, seed)),
              seed < 5 + suffice);
  }
}

TEST(CampaignRunner, refuses_a_part_of_the_seeds_where_a_rule_looks_at_all) {
  const TemporaryFolder folder;
  try {
    (void)run_campaign(early_campaign(), folder.path(), {.shard = {.index = 1, .count = 2}});
    FAIL() << "not refused";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), ::testing::HasSubstr("--shard: found 1/2"));
  }
}

TEST(CampaignRunner, two_shards_have_each_seed_once) {
  const TemporaryFolder first;
  const TemporaryFolder second;
  const Campaign campaign = testing::quick_campaign(5);
  (void)run_campaign(campaign, first.path(), {.shard = {.index = 1, .count = 2}});
  const CampaignProgress end =
      run_campaign(campaign, second.path(), {.shard = {.index = 2, .count = 2}});
  EXPECT_EQ(end.total, 4);
  EXPECT_THAT(seeds_in(first.path()), ::testing::ElementsAre(5U, 7U, 9U));
  EXPECT_THAT(seeds_in(second.path()), ::testing::ElementsAre(6U, 8U));
}

TEST(CampaignRunner, keeps_all_traces_when_asked_each_with_its_episode) {
  const TemporaryFolder folder;
  Campaign campaign = testing::quick_campaign(2);
  campaign.traces = TraceKeeping::kAll;
  (void)run_campaign(campaign, folder.path(), {.jobs = 2});
  for (const EpisodeRow& row : rows_in(folder.path())) {
    const Trace trace = read_trace(folder.path() + "/" + row.trace + "/episode.h5");
    EXPECT_EQ(trace.seed, row.seed);
    EpisodeRow again = episode_row(EpisodeView(trace), row.variant);
    EXPECT_EQ(again.cost, row.cost);
    EXPECT_EQ(again.min_clearance, row.min_clearance);
  }
}

TEST(CampaignRunner, keeps_the_traces_of_failures_and_of_a_sample) {
  const TemporaryFolder folder;
  Campaign campaign = testing::quick_campaign(4);
  campaign.variants.pop_back();
  campaign.traces = TraceKeeping::kFailures;
  campaign.trace_sample = 1;
  // One period per drive: then every state is at the target.
  campaign.variants[0].resolved.target.radius = 100.0;
  (void)run_campaign(campaign, folder.path(), {});
  for (const EpisodeRow& row : rows_in(folder.path())) {
    const bool wanted = row.seed == 5 || is_failure(row);
    EXPECT_EQ(!row.trace.empty(), wanted);
    EXPECT_EQ(fs::exists(folder / fmt::format("episodes/0/{}/episode.h5", row.seed)), wanted);
  }
}

TEST(CampaignRunner, keeps_no_trace_unless_asked) {
  const TemporaryFolder folder;
  (void)run_campaign(testing::quick_campaign(1), folder.path(), {});
  EXPECT_FALSE(fs::exists(folder / "episodes"));
}

/// A campaign in which the disturbance throws the car out of the simulator's range.
Campaign faulty_campaign() {
  Campaign campaign = testing::quick_campaign(2);
  campaign.variants.pop_back();
  Scenario& scenario = campaign.variants[0].resolved;
  scenario = with_plant(scenario, "mujoco_car");
  scenario.disturbance.covariance = Eigen::Vector3d(1e24, 1e24, 0.0).asDiagonal();
  return campaign;
}

TEST(CampaignRunner, counts_an_episode_that_faulted_as_one) {
  const TemporaryFolder folder;
  const CampaignProgress end = run_campaign(faulty_campaign(), folder.path(), {});
  EXPECT_EQ(end.done, 2);
  EXPECT_EQ(end.outcomes.at("fault"), 2);
  for (const EpisodeRow& row : rows_in(folder.path())) {
    EXPECT_FALSE(row.fault.empty());
    EXPECT_EQ(std::ssize(row.periods), row.steps - 1);
  }
}

TEST(CampaignRunner, repeats_faulted_episodes_only_when_asked) {
  const TemporaryFolder folder;
  (void)run_campaign(faulty_campaign(), folder.path(), {});
  const std::vector<EpisodeRow> before = rows_in(folder.path());
  EXPECT_EQ(run_campaign(faulty_campaign(), folder.path(), {}).fresh, 0);
  const CampaignProgress again =
      run_campaign(faulty_campaign(), folder.path(), {.retry_faults = true});
  EXPECT_EQ(again.fresh, 2);
  EXPECT_EQ(again.done, 2);
  EXPECT_EQ(again.outcomes.at("fault"), 2);
  EXPECT_EQ(rows_in(folder.path()), before);
}

TEST(CampaignRunner, refuses_a_vehicle_that_changed_since_the_campaign_began) {
  const TemporaryFolder folder;
  const TemporaryFolder out;
  const auto vehicle = [&](const char* mass) {
    return folder.file("box.xml", fmt::format("<mujoco><worldbody><body><joint type='slide'/>"
                                              "<geom size='.1' mass='{}'/></body></worldbody>"
                                              "</mujoco>",
                                              mass));
  };
  Campaign campaign = testing::quick_campaign(1);
  campaign.variants.pop_back();
  campaign.variants[0].resolved.plant = {.kind = "mujoco", .mjcf = vehicle("1")};
  CampaignOptions none;
  none.should_stop = [] { return true; };
  (void)run_campaign(campaign, out.path(), none);
  EXPECT_NO_THROW((void)run_campaign(campaign, out.path(), none));
  (void)vehicle("2");
  EXPECT_THROW((void)run_campaign(campaign, out.path(), none), InputError);
}

TEST(CampaignRunner, a_folder_has_one_runner_at_a_time) {
  const TemporaryFolder folder;
  const FolderLock other(folder.path());
  EXPECT_THROW((void)run_campaign(testing::quick_campaign(), folder.path(), {}), IoError);
  EXPECT_FALSE(fs::exists(folder / "campaign.sqlite"));
}

TEST(CampaignRunner, an_update_removes_the_traces_of_what_it_drops) {
  const TemporaryFolder folder;
  Campaign campaign = testing::quick_campaign(2);
  campaign.traces = TraceKeeping::kAll;
  (void)run_campaign(campaign, folder.path(), {});
  campaign.seeds.count = 1;
  StoreUpdate update;
  CampaignOptions options;
  options.update = true;
  options.on_update = [&](const StoreUpdate& told) { update = told; };
  EXPECT_EQ(run_campaign(campaign, folder.path(), options).done, 2);
  EXPECT_EQ(update.kept, 2);
  EXPECT_EQ(update.dropped, 2);
  EXPECT_TRUE(fs::exists(folder / "episodes/0/5"));
  EXPECT_FALSE(fs::exists(folder / "episodes/0/6"));
}

}  // namespace runner_test
}  // namespace qsmpc::harness
