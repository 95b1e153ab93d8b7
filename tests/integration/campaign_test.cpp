// Campaigns through the program: what they write, that no episode is lost or duplicated however
// they end, and what is refused.

#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <random>
#include <string>
#include <system_error>
#include <vector>

#include <SQLiteCpp/SQLiteCpp.h>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "harness/campaign/store/folder_lock.hpp"
#include "harness/trace/trace_file.hpp"
#include "tests/integration/campaign_fixture.hpp"
#include "tests/support/effort.hpp"

namespace qsmpc::harness {
namespace campaign_test {

namespace fs = std::filesystem;
using ::testing::AllOf;
using testing::files_below;
using testing::files_in;
using ::testing::HasSubstr;
using testing::ProcessOptions;
using testing::ProcessResult;
using testing::read_text;
using testing::results_of;
using testing::rows_of;
using testing::run_qsmpc;
using testing::short_campaign;
using testing::TemporaryFolder;

ProcessResult campaign(const std::string& file, const std::string& out,
                       std::vector<std::string> more = {}, const ProcessOptions& options = {}) {
  std::vector<std::string> arguments{"campaign", file, "--out", out};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return testing::run_qsmpc(arguments, options);
}

TEST(Campaign, leaves_a_store_numbers_and_figures) {
  const TemporaryFolder folder;
  const ProcessResult result = campaign(testing::short_campaign(folder, 3), folder / "out");
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  for (const char* name :
       {"campaign.sqlite", "campaign.json", "campaign.yaml", "episodes.csv", "variants.csv",
        "differences.csv", "calibration.csv", "reliability.svg", "report.html"}) {
    EXPECT_TRUE(testing::files_in(folder / "out").contains(name)) << name;
  }
  EXPECT_THAT(result.output, AllOf(HasSubstr("closed"), HasSubstr("open")));
  EXPECT_THAT(result.errors, HasSubstr("driving: 6 of 6"));
  EXPECT_TRUE(testing::files_below(folder / "out", ".partial").empty());
  EXPECT_TRUE(testing::files_below(folder / "out", "-wal").empty());
  fs::remove(folder / "out/report.html");
  const ProcessResult report = testing::run_qsmpc({"report", folder / "out"});
  EXPECT_EQ(report.exit_code, 0) << report.errors;
  EXPECT_EQ(report.output, folder / "out/report.html" + std::string("\n"));
  EXPECT_THAT(testing::read_text(folder / "out/report.html"),
              HasSubstr("No certificate is refuted"));
}

TEST(Campaign, json_has_the_keys_that_other_programs_read) {
  const TemporaryFolder folder;
  const ProcessResult result =
      campaign(testing::short_campaign(folder, 2), folder / "out", {"--json", "--quiet"});
  EXPECT_EQ(result.errors, "");
  EXPECT_EQ(result.output, testing::read_text(folder / "out/campaign.json"));
  const auto json = nlohmann::json::parse(result.output);
  EXPECT_EQ(json["episodes"], 4);
  EXPECT_EQ(json["done"], 4);
  EXPECT_EQ(json["outcomes"]["timeout"], 4);
  const auto& closed = json["variants"]["closed, limit.steps=6"];
  EXPECT_EQ(closed["outcomes"]["timeout"], 2);
  EXPECT_EQ(closed["reached_rate"], 0.0);
  EXPECT_EQ(closed["reached_interval"].size(), 2U);
  EXPECT_EQ(closed["unsafe_step_rate"], 0.0);
  EXPECT_GT(closed["certified_step_rate"], 0.0);
  EXPECT_GT(closed["ocp_ms"]["median"], 0.0);
}

TEST(Campaign, results_do_not_depend_on_the_number_of_jobs) {
  const TemporaryFolder folder;
  const std::string file = testing::short_campaign(folder, 6);
  ASSERT_EQ(campaign(file, folder / "one", {"--jobs", "1"}).exit_code, 0);
  ASSERT_EQ(campaign(file, folder / "three", {"--jobs", "3"}).exit_code, 0);
  EXPECT_EQ(testing::rows_of(folder / "one"), testing::rows_of(folder / "three"));
  EXPECT_EQ(testing::results_of(folder / "one"), testing::results_of(folder / "three"));
}

/// Starts the campaign and kills it after `delay`, unless it ends earlier.
int run_and_kill(const std::string& file, const std::string& out, std::chrono::microseconds delay) {
  const auto start = std::chrono::steady_clock::now();
  ProcessOptions options;
  options.meanwhile = [&](pid_t process) {
    if (std::chrono::steady_clock::now() - start < delay) return false;
    kill(process, SIGKILL);
    return true;
  };
  return campaign(file, out, {"--quiet"}, options).exit_code;
}

TEST(Campaign, a_rule_stops_it_after_the_same_seeds_for_any_number_of_jobs_and_after_a_kill) {
  const TemporaryFolder folder;
  const std::string file = testing::short_campaign(
      folder, 60, "until: {rate_halfwidth: 0.2, confidence: 0.9, of: timeout}\n");
  ASSERT_EQ(campaign(file, folder / "one", {"--jobs", "1"}).exit_code, 0);
  const ProcessResult three = campaign(file, folder / "three", {"--jobs", "3"});
  ASSERT_EQ(three.exit_code, 0) << three.errors;
  (void)run_and_kill(file, folder / "killed", std::chrono::milliseconds(300));
  ASSERT_EQ(campaign(file, folder / "killed", {"--jobs", "2"}).exit_code, 0);
  const std::string results = testing::results_of(folder / "one");
  EXPECT_EQ(results, testing::results_of(folder / "three"));
  EXPECT_EQ(results, testing::results_of(folder / "killed"));
  EXPECT_EQ(testing::rows_of(folder / "one"), testing::rows_of(folder / "killed"));
  const auto json = nlohmann::json::parse(testing::read_text(folder / "one/campaign.json"));
  const int seeds = json["until"]["stopped_after"];
  EXPECT_GT(seeds, 1);
  EXPECT_LT(seeds, 60);
  EXPECT_EQ(json["done"], 2 * seeds);
  EXPECT_THAT(three.output, HasSubstr(fmt::format("Stopped by its rule after {} of", seeds)));
  EXPECT_THAT(testing::read_text(folder / "one/report.html"),
              HasSubstr(fmt::format("Stopped by its rule after {} of at most 60 seeds", seeds)));
  const ProcessResult part = campaign(file, folder / "part", {"--shard", "1/2"});
  EXPECT_EQ(part.exit_code, 2);
  EXPECT_THAT(part.errors, HasSubstr("--shard: found 1/2, expected all seeds in one folder"));
}

/// Number of episodes that the store in `out` reports as done; 0 if there is no store yet.
int done_in(const std::string& out) {
  const ProcessResult status = testing::run_qsmpc({"campaign", "status", out, "--json"});
  return status.exit_code == 0 ? nlohmann::json::parse(status.output)["done"].get<int>() : 0;
}

void expect_same_campaign(const std::string& again, const std::string& once) {
  EXPECT_EQ(testing::rows_of(again), testing::rows_of(once));
  EXPECT_EQ(testing::results_of(again), testing::results_of(once));
  const std::vector<std::string> traces = testing::files_below(again, ".h5");
  EXPECT_EQ(traces, testing::files_below(once, ".h5"));
  for (const std::string& name : traces) {
    const Trace trace = read_trace(again + "/" + name);
    const Trace expected = read_trace(once + "/" + name);
    EXPECT_EQ(trace.outcome, expected.outcome);
    EXPECT_EQ(trace.final_state, expected.final_state);
  }
  EXPECT_TRUE(testing::files_below(again, ".partial").empty());
}

TEST(Campaign, killed_at_any_moment_and_started_again_it_ends_as_if_it_never_was) {
  const TemporaryFolder folder;
  const std::string whole = folder / "whole";
  const std::string killed = folder / "killed";
  const std::string file =
      testing::short_campaign(folder, 100, "traces: failures\ntrace_sample: 3\n");
  const auto start = std::chrono::steady_clock::now();
  ASSERT_EQ(campaign(file, whole, {"--quiet"}).exit_code, 0);
  const auto duration = std::chrono::duration_cast<std::chrono::microseconds>(
      std::chrono::steady_clock::now() - start);
  // A campaign is killed about five times before it completes; then it is compared and the next one
  // starts. Only the number of campaigns depends on the machine's speed.
  std::mt19937 random(17);  // NOLINT(cert-msc32-c,cert-msc51-cpp): the clock adds the rest
  std::uniform_int_distribution<std::int64_t> microseconds(0, 2 * duration.count() / 5);
  int done = 0;
  for (int kills = 0; kills < testing::by_effort(4, 12, 200);) {
    const int code = run_and_kill(file, killed, std::chrono::microseconds(microseconds(random)));
    if (code == 0) {
      expect_same_campaign(killed, whole);
      fs::remove_all(killed);
      done = 0;
      continue;
    }
    ASSERT_EQ(code, 128 + SIGKILL);
    // On every other kill the next start finds the store exactly as the kill left it.
    if (++kills % 2 != 0) continue;
    const int still_done = done_in(killed);
    EXPECT_GE(still_done, done) << "an episode that was done is lost";
    done = still_done;
  }
  const ProcessResult last = campaign(file, killed, {"--quiet"});
  ASSERT_EQ(last.exit_code, 0) << last.errors;
  expect_same_campaign(killed, whole);
}

TEST(Campaign, a_full_disk_loses_nothing_that_was_done) {
  const TemporaryFolder folder;
  const std::string file = testing::short_campaign(folder, 60);
  ASSERT_EQ(campaign(file, folder / "whole", {"--quiet"}).exit_code, 0);
  const std::string out = folder / "small";
  const testing::SmallDisk disk(out);
  for (int attempt = 0; attempt < 2; ++attempt) {
    const ProcessResult full = campaign(file, out, {"--quiet"}, disk.when_small());
    EXPECT_EQ(full.exit_code, 3) << full.errors;
    EXPECT_THAT(full.errors, HasSubstr("campaign.sqlite"));
    EXPECT_EQ(testing::files_in(out).count("campaign.json"), 0U);
  }
  disk.grow();
  const std::size_t kept = testing::rows_of(out).size();
  EXPECT_GT(kept, 2U + 8U) << "not even one episode had space";
  EXPECT_LT(kept, testing::rows_of(folder / "whole").size());
  const ProcessResult last = campaign(file, out, {"--quiet"});
  ASSERT_EQ(last.exit_code, 0) << last.errors;
  EXPECT_EQ(testing::rows_of(out), testing::rows_of(folder / "whole"));
  EXPECT_EQ(testing::results_of(out), testing::results_of(folder / "whole"));
}

TEST(Campaign, a_store_of_a_newer_schema_is_refused_and_left_alone) {
  const TemporaryFolder folder;
  const std::string file = testing::short_campaign(folder, 1);
  const std::string out = folder / "out";
  ASSERT_EQ(campaign(file, out).exit_code, 0);
  {
    SQLite::Database(out + "/campaign.sqlite", SQLite::OPEN_READWRITE)
        .exec("PRAGMA user_version = 77");
  }
  const std::string before = testing::read_text(out + "/campaign.sqlite");
  for (const ProcessResult& result : {campaign(file, out), campaign(file, out, {"--update"}),
                                      testing::run_qsmpc({"campaign", "status", out})}) {
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_THAT(result.errors, HasSubstr("schema 77, made by a newer qsmpc"));
  }
  EXPECT_EQ(testing::read_text(out + "/campaign.sqlite"), before);
}

TEST(Campaign, a_second_process_is_told_who_holds_the_folder) {
  const TemporaryFolder folder;
  const std::string file = testing::short_campaign(folder, 60);
  const std::string out = folder / "out";
  ProcessResult second;
  ProcessOptions options;
  pid_t first_process = 0;
  options.meanwhile = [&](pid_t process) {
    if (!fs::exists(out) || !lock_holder(out)) return false;
    first_process = process;
    second = campaign(file, out);
    return true;
  };
  const ProcessResult first = campaign(file, out, {"--quiet", "--jobs", "1"}, options);
  EXPECT_EQ(first.exit_code, 0) << first.errors;
  EXPECT_EQ(second.exit_code, 3);
  EXPECT_THAT(second.errors, HasSubstr(fmt::format("being run by process {} on", first_process)));
  EXPECT_EQ(nlohmann::json::parse(testing::read_text(out + "/campaign.json"))["done"], 120);
}

TEST(Campaign, ctrl_c_keeps_what_is_done_and_says_how_to_resume) {
  const TemporaryFolder folder;
  const std::string file = testing::short_campaign(folder, 200);
  const std::string out = folder / "out";
  ProcessOptions options;
  options.meanwhile = [&](pid_t process) {
    if (done_in(out) < 3) return false;
    kill(process, SIGINT);
    return true;
  };
  const ProcessResult stopped = campaign(file, out, {"--quiet", "--jobs", "1"}, options);
  EXPECT_EQ(stopped.exit_code, 130);
  EXPECT_THAT(stopped.errors, HasSubstr("of 400 episodes are done and kept"));
  const auto json = nlohmann::json::parse(testing::read_text(out + "/campaign.json"));
  EXPECT_GE(json["done"], 3);
  EXPECT_LT(json["done"], 400);
  EXPECT_EQ(campaign(file, out, {"--quiet"}).exit_code, 0);
  EXPECT_EQ(nlohmann::json::parse(testing::read_text(out + "/campaign.json"))["done"], 400);
}

TEST(Campaign, its_status_can_be_read_while_it_runs) {
  const TemporaryFolder folder;
  const std::string out = folder / "out";
  ProcessResult status;
  pid_t running = 0;
  ProcessOptions options;
  options.meanwhile = [&](pid_t process) {
    status = testing::run_qsmpc({"campaign", "status", out, "--json"});
    running = process;
    return status.exit_code == 0 && nlohmann::json::parse(status.output)["done"] > 0;
  };
  ASSERT_EQ(campaign(testing::short_campaign(folder, 60), out, {"--quiet", "--jobs", "1"}, options)
                .exit_code,
            0);
  const auto json = nlohmann::json::parse(status.output);
  EXPECT_EQ(json["episodes"], 120);
  EXPECT_EQ(json["running"]["process"], running);
  EXPECT_GT(json["rate"], 0.0);
  EXPECT_GT(json["left"], 0.0);
  const auto after =
      nlohmann::json::parse(testing::run_qsmpc({"campaign", "status", out, "--json"}).output);
  EXPECT_EQ(after["done"], 120);
  EXPECT_TRUE(after["running"].is_null());
}

TEST(Campaign, shards_merge_into_what_one_machine_drives) {
  const TemporaryFolder folder;
  const std::string file = testing::short_campaign(folder, 5, "traces: all\n");
  ASSERT_EQ(campaign(file, folder / "whole").exit_code, 0);
  ASSERT_EQ(campaign(file, folder / "a", {"--shard", "1/2"}).exit_code, 0);
  const std::vector<std::string> merge{"campaign",   "merge", folder / "a",
                                       folder / "b", "--out", folder / "merged"};
  EXPECT_EQ(testing::run_qsmpc(merge).exit_code, 2);
  ASSERT_EQ(campaign(file, folder / "b", {"--shard", "2/2"}).exit_code, 0);
  const ProcessResult merged = testing::run_qsmpc(merge);
  ASSERT_EQ(merged.exit_code, 0) << merged.errors;
  EXPECT_EQ(testing::rows_of(folder / "merged"), testing::rows_of(folder / "whole"));
  EXPECT_EQ(testing::results_of(folder / "merged"), testing::results_of(folder / "whole"));
  EXPECT_EQ(testing::files_below(folder / "merged", ".h5"),
            testing::files_below(folder / "whole", ".h5"));
}

TEST(Campaign, a_changed_campaign_is_refused_without_update) {
  const TemporaryFolder folder;
  const std::string out = folder / "out";
  ASSERT_EQ(campaign(testing::short_campaign(folder, 3), out).exit_code, 0);
  const std::string longer = testing::short_campaign(folder, 5);
  const ProcessResult refused = campaign(longer, out);
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_THAT(refused.errors, AllOf(HasSubstr("seeds: found 3 to 5"), HasSubstr("--update")));
  const ProcessResult told = campaign(longer, out, {"--update"});
  EXPECT_EQ(told.exit_code, 0);
  EXPECT_THAT(told.errors, HasSubstr("6 episodes are kept, 0 are no longer asked for"));
  ASSERT_EQ(campaign(longer, folder / "fresh").exit_code, 0);
  EXPECT_EQ(testing::results_of(out), testing::results_of(folder / "fresh"));
}

TEST(Campaign, a_dry_run_shows_the_plan_and_writes_nothing) {
  const TemporaryFolder folder;
  const ProcessResult result =
      campaign(testing::short_campaign(folder, 7), folder / "out", {"--dry-run"});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_THAT(result.output, AllOf(HasSubstr("14"), HasSubstr("controller.policy=open_loop")));
  EXPECT_FALSE(fs::exists(folder / "out"));
}

TEST(Campaign, exits_with_failure_on_the_outcomes_of_fail_on) {
  const TemporaryFolder folder;
  const std::string file = testing::short_campaign(folder, 1);
  EXPECT_EQ(campaign(file, folder / "out").exit_code, 0);
  EXPECT_EQ(campaign(file, folder / "out", {"--fail-on", "timeout"}).exit_code, 1);
  EXPECT_EQ(campaign(file, folder / "out", {"--fail-on", "unsafe,fault"}).exit_code, 0);
  EXPECT_EQ(campaign(file, folder / "out", {"--fail-on", "risk_exceeded"}).exit_code, 0);
  const std::string limited =
      folder.file("limited.yaml",
                  "scenario: dubins_corridor\nseeds: [3]\n"
                  "variants: {limited: {risk: {plan: 0}, limit.steps: 2}}\n");
  EXPECT_EQ(campaign(limited, folder / "limited").exit_code, 0);
  EXPECT_EQ(campaign(limited, folder / "limited", {"--fail-on", "risk_exceeded"}).exit_code, 1);
}

TEST(Campaign, wrong_usage_is_reported_in_one_line) {
  const TemporaryFolder folder;
  const std::string file = testing::short_campaign(folder, 1);
  const std::string out = folder / "out";
  for (const ProcessResult& result :
       {testing::run_qsmpc({"campaign"}), campaign(folder / "none.yaml", out),
        campaign(file, out, {"--shard", "3/2"}), campaign(file, out, {"--shard", "1"}),
        campaign(file, out, {"--jobs", "0"}), testing::run_qsmpc({"campaign", "status", out}),
        testing::run_qsmpc({"campaign", "merge", out, "--out", folder / "merged"}),
        campaign(folder.file("broken.yaml", "name: x\nscenario: dubins_corridor\nseed: 3\n"),
                 out)}) {
    EXPECT_EQ(result.exit_code, 2) << result.errors;
    EXPECT_EQ(std::ranges::count(result.errors, '\n'), 1) << result.errors;
    EXPECT_FALSE(fs::exists(out));
  }
}

}  // namespace campaign_test
}  // namespace qsmpc::harness
