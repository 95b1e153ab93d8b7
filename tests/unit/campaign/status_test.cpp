#include "harness/campaign/status.hpp"

#include <ctime>
#include <memory>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include "harness/campaign/store/store.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/unit/campaign/campaign_fixture.hpp"

namespace qsmpc::harness {
namespace status_test {

using testing::example_row;
using ::testing::HasSubstr;

class Status : public ::testing::Test {
 protected:
  Status() {
    const Campaign campaign = testing::quick_campaign();
    store = std::make_unique<Store>(folder.path(), stored_campaign(campaign, {}),
                                    stored_variants(campaign, {"", ""}), campaign.seeds, false);
  }
  void add_now(std::uint64_t seed, const std::string& outcome) {
    EpisodeRow row = testing::example_row(0, seed, outcome);
    row.timing.finished_at = static_cast<double>(std::time(nullptr));
    store->add(row, false);
  }
  testing::TemporaryFolder folder;
  std::unique_ptr<Store> store;
};

TEST_F(Status, counts_what_is_done_while_the_store_is_written) {
  add_now(5, "reached");
  add_now(6, "timeout");
  const CampaignStatus status = campaign_status(folder.path());
  EXPECT_EQ(status.done, 2);
  EXPECT_EQ(status.campaign.episodes, 8);
  EXPECT_FALSE(status.running);
  EXPECT_EQ(status.rate, 0.0);
  EXPECT_THAT(status_table(status), HasSubstr("2 of 8 (25.0 %)"));
  EXPECT_THAT(status_table(status), HasSubstr("reached 1, timeout 1"));
  EXPECT_THAT(status_table(status), HasSubstr("running   no"));
}

TEST_F(Status, tells_who_works_on_it_and_how_fast) {
  const FolderLock lock(folder.path());
  EpisodeRow old = testing::example_row(0, 7);
  old.timing.finished_at = 1e6;
  store->add(old, false);
  add_now(5, "reached");
  const CampaignStatus status = campaign_status(folder.path());
  ASSERT_TRUE(status.running);
  EXPECT_EQ(status.running->process, ::getpid());
  // The window is between one second and one minute long, by the clock.
  EXPECT_GE(status.rate, 1.0 / 60.0);
  EXPECT_LE(status.rate, 1.0);
  ASSERT_TRUE(status.left);
  EXPECT_DOUBLE_EQ(*status.left * status.rate, 6.0);
  const auto json = nlohmann::json::parse(status_json(status));
  EXPECT_EQ(json["done"], 2);
  EXPECT_EQ(json["outcomes"]["reached"], 2);
  EXPECT_EQ(json["running"]["process"], ::getpid());
}

TEST(ProgressNote, tells_rate_time_left_and_outcomes) {
  const CampaignProgress progress{
      .done = 60,
      .total = 100,
      .fresh = 20,
      .elapsed = 40.0,
      .outcomes = {
          {"collision", 2}, {"fault", 0}, {"left_safe_set", 1}, {"reached", 54}, {"timeout", 3}}};
  EXPECT_EQ(progress_note(progress),
            "0.5 episodes/s, 1 min 20 s left, reached 54, collision 2, timeout 3, left_safe_set 1");
}

TEST(Durations, are_shown_in_their_two_largest_units) {
  EXPECT_EQ(duration_text(0.0), "0 ms");
  EXPECT_EQ(duration_text(0.85), "850 ms");
  EXPECT_EQ(duration_text(12.4), "12 s");
  EXPECT_EQ(duration_text(59.6), "1 min 0 s");
  EXPECT_EQ(duration_text(80.0), "1 min 20 s");
  EXPECT_EQ(duration_text(3.0 * 3600.0 + 300.0), "3 h 5 min");
  EXPECT_EQ(duration_text(3599.7), "1 h 0 min");
  EXPECT_EQ(duration_text(86400.0 * 2.5), "2 d 12 h");
}

}  // namespace status_test
}  // namespace qsmpc::harness
