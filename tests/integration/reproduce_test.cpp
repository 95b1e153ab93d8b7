// `qsmpc reproduce` from the outside: exit codes, output, files left behind.

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/integration/process.hpp"

namespace qsmpc::harness {
namespace reproduce_test {

using namespace testing;

namespace fs = std::filesystem;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsSupersetOf;
using ::testing::Not;

ProcessResult reproduce(const std::string& out, const std::vector<std::string>& more,
                        const ProcessOptions& options = {}) {
  std::vector<std::string> arguments = {"reproduce"};
  if (!out.empty()) arguments.insert(arguments.end(), {"--out", out});
  arguments.insert(arguments.end(), more.begin(), more.end());
  if (std::ranges::find(more, "--seeds") == more.end()) {
    arguments.insert(arguments.end(), {"--seeds", "2"});
  }
  return run_qsmpc(arguments, options);
}

TEST(Reproduce, leaves_numbers_page_text_and_every_figure_that_they_name) {
  const TemporaryFolder folder;
  const ProcessResult result = reproduce(folder.path(), {"figure-4-1", "--json", "--quiet"});
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_EQ(result.errors, "");
  EXPECT_EQ(result.output, read_text(folder.path() + "/results.json"));
  const auto json = nlohmann::json::parse(result.output);
  EXPECT_EQ(json["complete"], true);
  EXPECT_EQ(json["seeds"], 2);
  std::set<std::string> expected{"results.json", "results.md", "results.html"};
  for (const auto& experiment : json["experiments"]) {
    for (const auto& figure : experiment["figures"]) expected.insert(figure);
  }
  EXPECT_GT(expected.size(), 3U);
  EXPECT_EQ(files_in(folder.path()), expected);
  for (const std::string& file : expected) {
    EXPECT_FALSE(read_text(folder.path() + "/" + file).empty()) << file;
  }
}

TEST(Reproduce, prints_a_table_and_uses_a_folder_by_default) {
  const TemporaryFolder folder;
  const ProcessResult result = reproduce("", {"figure-4-1"}, {.folder = folder.path()});
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_THAT(result.output, HasSubstr("figure-4-1: "));
  EXPECT_THAT(result.output, HasSubstr("out/reproduce/results.html"));
  EXPECT_TRUE(fs::exists(folder.path() + "/out/reproduce/results.json"));
  EXPECT_THAT(result.errors, HasSubstr("reproducing: 1 of 1"));
}

TEST(Reproduce, an_unknown_experiment_is_refused_before_anything_is_written) {
  const TemporaryFolder folder;
  const ProcessResult result = reproduce(folder.path() + "/new", {"figure-4-1", "table-5-9"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.errors, HasSubstr("table-5-9"));
  EXPECT_THAT(result.errors, HasSubstr("table-5-1"));
  EXPECT_FALSE(fs::exists(folder.path() + "/new"));
}

/// Sends `signal` once the first experiment is written; many drives are still to come.
ProcessResult stop_after_first(const std::string& out, int signal) {
  return reproduce(out, {"figure-4-1", "table-5-4", "--seeds", "2000", "--quiet"},
                   {.meanwhile = [&](pid_t process) {
                     if (!fs::exists(out + "/results.json")) return false;
                     kill(process, signal);
                     return true;
                   }});
}

TEST(Reproduce, interrupted_keeps_the_experiments_that_are_finished) {
  const TemporaryFolder folder;
  const std::string numbers = folder.path() + "/results.json";
  const ProcessResult result = stop_after_first(folder.path(), SIGINT);
  EXPECT_EQ(result.exit_code, 130) << result.errors;
  EXPECT_THAT(result.errors, HasSubstr("1 of 2 experiments are finished and kept"));
  const auto json = nlohmann::json::parse(read_text(numbers));
  EXPECT_EQ(json["complete"], false);
  EXPECT_EQ(json["experiments"].size(), 1U);
  EXPECT_THAT(read_text(folder.path() + "/results.html"),
              HasSubstr("Not all of the requested experiments have finished"));
}

TEST(Reproduce, killed_it_leaves_whole_files_only) {
  const TemporaryFolder folder;
  const std::string numbers = folder.path() + "/results.json";
  const ProcessResult result = stop_after_first(folder.path(), SIGKILL);
  EXPECT_EQ(result.exit_code, 128 + SIGKILL);
  EXPECT_EQ(nlohmann::json::parse(read_text(numbers))["experiments"].size(), 1U);
  EXPECT_THAT(files_in(folder.path()),
              IsSupersetOf(std::vector<std::string>{"results.html", "results.md"}));
  EXPECT_THAT(files_in(folder.path()), Not(Contains(HasSubstr(".partial"))));
}

TEST(Reproduce, numbers_do_not_depend_on_the_threads) {
  const TemporaryFolder folder;
  const auto rows = [&](const char* name, const char* threads) {
    const ProcessResult result =
        reproduce(folder.path() + "/" + name, {"figure-4-1", "--threads", threads, "--json"});
    EXPECT_EQ(result.exit_code, 0) << result.errors;
    return nlohmann::json::parse(result.output)["rows"].dump();
  };
  EXPECT_EQ(rows("one", "1"), rows("two", "2"));
}

TEST(Reproduce, a_full_disk_is_reported) {
  const TemporaryFolder folder;
  const ProcessResult result =
      reproduce(folder.path(), {"figure-4-1", "--quiet"}, {.file_size_limit = 200});
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_EQ(files_in(folder.path()).count("results.json"), 0U);
}

TEST(Reproduce, help_lists_the_experiments) {
  const ProcessResult result = run_qsmpc({"reproduce", "--help"});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_THAT(result.output, HasSubstr("table-5-2"));
  EXPECT_THAT(result.output, HasSubstr("Example: "));
}

}  // namespace reproduce_test
}  // namespace qsmpc::harness
