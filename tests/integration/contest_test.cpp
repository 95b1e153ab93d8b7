// Contests through the program: what they write, and that a killed and restarted contest ends like
// an uninterrupted one.

#include <chrono>
#include <csignal>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/integration/campaign_fixture.hpp"

namespace qsmpc::harness {
namespace contest_test {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using testing::ProcessOptions;
using testing::ProcessResult;
using testing::TemporaryFolder;

/// Short drives of two controllers, one of them with a choice of settings.
std::string short_contest(const TemporaryFolder& folder, int seeds, const std::string& more = "",
                          const std::string& common = "limit.steps: 6") {
  return folder.file("short.yaml",
                     fmt::format("name: short\n"
                                 "controllers:\n"
                                 "  quantised: {{controller.kind: quantised}}\n"
                                 "  lqr: {{controller.kind: lqr}}\n"
                                 "common: {{{}}}\n"
                                 "scenarios: [dubins_corridor]\n"
                                 "plants: [analytic]\n"
                                 "seeds: {{first: 3, count: {}}}\n"
                                 "tuning:\n"
                                 "  seeds: {{first: 1000, count: 2}}\n"
                                 "  budget: 2\n"
                                 "  search:\n"
                                 "    quantised: {{controller.policy: [open_loop, closed_loop]}}\n"
                                 "timing: {{seeds: 1}}\n{}",
                                 common, seeds, more));
}

ProcessResult contest(const std::string& file, const std::string& out,
                      std::vector<std::string> more = {}, const ProcessOptions& options = {}) {
  std::vector<std::string> arguments{"contest", file, "--out", out};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return testing::run_qsmpc(arguments, options);
}

TEST(Contest, leaves_a_page_numbers_and_the_stores_of_its_drives) {
  const TemporaryFolder folder;
  const std::string out = folder / "out";
  const ProcessResult result = contest(short_contest(folder, 3), out);
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  for (const char* name : {"contest.html", "contest.json", "contest.csv", "contest.yaml",
                           "report.html", "campaign.sqlite"}) {
    EXPECT_TRUE(testing::files_in(out).contains(name)) << name;
  }
  EXPECT_TRUE(testing::files_below(out, ".partial").empty());
  EXPECT_THAT(result.errors, AllOf(HasSubstr("tuning: 4 of 4"), HasSubstr("driving: 6 of 6"),
                                   HasSubstr("timing: 2 of 2")));
  EXPECT_THAT(result.output,
              AllOf(HasSubstr("Fewest unsafe drives: quantised, lqr (0 %)"),
                    HasSubstr("lqr: No significant difference in safety from quantised")));
  EXPECT_EQ(testing::rows_of(out + "/tuning").size(), 2U + 4U + 4U * 6U + 4U);
}

TEST(Contest, draws_a_figure_where_drives_arrive) {
  const TemporaryFolder folder;
  const std::string out = folder / "out";
  const std::string stranded = short_contest(folder, 2);
  const ProcessResult without = contest(stranded, out, {"--quiet"});
  ASSERT_EQ(without.exit_code, 0) << without.errors;
  EXPECT_FALSE(testing::files_in(out).contains("contest.svg")) << "no drive arrives";
  EXPECT_THAT(without.output, Not(HasSubstr("contest.svg")));
  const std::string arriving = short_contest(folder, 2, "", "limit.steps: 20, target.radius: 10.8");
  const ProcessResult with = contest(arriving, folder / "arriving", {"--quiet"});
  ASSERT_EQ(with.exit_code, 0) << with.errors;
  for (const char* name : {"contest.svg", "contest.pdf"}) {
    EXPECT_TRUE(testing::files_in(folder / "arriving").contains(name)) << name;
  }
  EXPECT_THAT(with.output, HasSubstr("contest.svg, contest.pdf"));
}

TEST(Contest, json_has_what_was_tried_and_what_everybody_believed) {
  const TemporaryFolder folder;
  const ProcessResult result =
      contest(short_contest(folder, 2), folder / "out", {"--json", "--quiet"});
  EXPECT_EQ(result.errors, "");
  EXPECT_EQ(result.output, testing::read_text(folder / "out/contest.json"));
  const auto json = nlohmann::json::parse(result.output);
  EXPECT_EQ(json["done"], 4);
  EXPECT_EQ(json["reference"], "quantised");
  EXPECT_EQ(json["tuning"]["budget"], 2);
  const auto& quantised = json["controllers"]["quantised"];
  ASSERT_EQ(quantised["tried"].size(), 2U);
  EXPECT_EQ(quantised["tried"][0]["drives"], 2);
  EXPECT_NE(quantised["tried"][0]["chosen"], quantised["tried"][1]["chosen"]);
  EXPECT_EQ(quantised["overall"]["believed"]["drives"], 2);
  EXPECT_EQ(quantised["overall"]["timeout"]["rate"], 1.0);
  EXPECT_GT(quantised["overall"]["ocp_ms"]["median"], 0.0);
  const auto& lqr = json["controllers"]["lqr"];
  EXPECT_TRUE(lqr["tried"].empty());
  EXPECT_EQ(lqr["overall"]["believed"]["drives"], 0);
  EXPECT_EQ(lqr["overall"]["versus"]["unsafe"]["result"], "tie");
  EXPECT_THAT(lqr["words"].get<std::string>(), HasSubstr("No significant difference in safety"));
}

/// Starts the contest and kills it after `delay`, unless it ends earlier.
int contest_and_kill(const std::string& file, const std::string& out,
                     std::chrono::milliseconds delay) {
  const auto start = std::chrono::steady_clock::now();
  ProcessOptions options;
  options.meanwhile = [&](pid_t process) {
    if (std::chrono::steady_clock::now() - start < delay) return false;
    kill(process, SIGKILL);
    return true;
  };
  return contest(file, out, {"--quiet"}, options).exit_code;
}

TEST(Contest, that_was_killed_again_and_again_ends_as_one_that_was_not) {
  const TemporaryFolder folder;
  const std::string file = short_contest(folder, 12);
  ASSERT_EQ(contest(file, folder / "once", {"--quiet"}).exit_code, 0);
  int killed = 0;
  int delay = 40;
  while (contest_and_kill(file, folder / "again", std::chrono::milliseconds(delay)) != 0) {
    ++killed;
    delay += delay / 4;  // eventually it is long enough
    ASSERT_LT(killed, 40);
  }
  EXPECT_GT(killed, 1);
  for (const std::string part : {"", "/tuning", "/timing"}) {
    EXPECT_EQ(testing::rows_of(folder / "again" + part), testing::rows_of(folder / "once" + part));
  }
  EXPECT_EQ(testing::json_without_timings(folder / "again/contest.json"),
            testing::json_without_timings(folder / "once/contest.json"));
  EXPECT_EQ(testing::results_of(folder / "again"), testing::results_of(folder / "once"));
}

TEST(Contest, that_has_changed_is_refused_without_update) {
  const TemporaryFolder folder;
  const std::string out = folder / "out";
  ASSERT_EQ(contest(short_contest(folder, 2), out, {"--quiet"}).exit_code, 0);
  const ProcessResult refused = contest(short_contest(folder, 3), out, {"--quiet"});
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_THAT(refused.errors, AllOf(HasSubstr("seeds: found 3 to 4"), HasSubstr("--update")));
  const ProcessResult updated = contest(short_contest(folder, 3), out, {"--update"});
  EXPECT_EQ(updated.exit_code, 0) << updated.errors;
  EXPECT_THAT(updated.errors, HasSubstr("4 episodes are kept, 0 are no longer asked for"));
}

TEST(Contest, is_checked_shown_and_listed_without_driving) {
  const TemporaryFolder folder;
  const std::string file = short_contest(folder, 3);
  const ProcessResult shown = testing::run_qsmpc({"contest", file, "--dry-run"});
  EXPECT_EQ(shown.exit_code, 0) << shown.errors;
  EXPECT_THAT(shown.output,
              AllOf(HasSubstr("quantised (the reference)"), HasSubstr("search    4 drives"),
                    HasSubstr("contest   6 drives")));
  EXPECT_THAT(testing::run_qsmpc({"validate", file}).output, HasSubstr("= 6 drives, ok"));
  const std::string wrong = short_contest(folder, 3, "referee: me\n");
  const ProcessResult verdict = testing::run_qsmpc({"validate", wrong});
  EXPECT_EQ(verdict.exit_code, 2);
  EXPECT_THAT(verdict.output, HasSubstr("short.yaml:15: referee: found"));
  EXPECT_THAT(testing::run_qsmpc({"list", "contests"}).output, HasSubstr("  rivals "));
}

}  // namespace contest_test
}  // namespace qsmpc::harness
