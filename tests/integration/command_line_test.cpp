// The command line from the outside: its help and version, its answers to unknown arguments, and
// the starter scenario that it writes.
#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/integration/process.hpp"

namespace qsmpc::harness {
namespace command_line_test {

using namespace testing;

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

void expect_refused(const std::vector<std::string>& arguments, const std::string& message) {
  const ProcessResult result = run_qsmpc(arguments);
  EXPECT_EQ(result.exit_code, 2) << message;
  EXPECT_EQ(result.output, "");
  EXPECT_EQ(std::ranges::count(result.errors, '\n'), 1) << result.errors;
  EXPECT_THAT(result.errors, HasSubstr(message));
}

TEST(CommandLine, names_a_command_that_is_not_known_and_the_nearest) {
  expect_refused({"rnu", "dubins_corridor"}, "found rnu, expected a command: run (known: ");
  expect_refused({"zoology"}, "found zoology, expected a command: one of ");
  expect_refused({"campaign", "sttaus", "x", "--jsn"}, "qsmpc campaign --help");
}

TEST(CommandLine, suggests_the_nearest_option) {
  expect_refused({"run", "dubins_corridor", "--sed", "3"}, "found --sed, expected --set or --seed");
  expect_refused({"run", "dubins_corridor", "--no-vide=1"}, "expected --no-video");
  expect_refused({"predict", "dubins_corridor", "--stpes", "3"}, "expected --steps");
  expect_refused({"campaign", "status", "x", "--jsno"}, "found --jsno, expected --json");
  expect_refused({"run", "dubins_corridor", "another"},
                 "found another, expected no more arguments");
}

TEST(CommandLine, refuses_an_invalid_seed) {
  for (const char* command : {"run", "predict", "compare"}) {
    expect_refused({command, "dubins_corridor", "--seed", "-1"},
                   "--seed: found -1, expected a whole number from 0 to 18446744073709551615");
  }
  expect_refused({"run", "dubins_corridor", "--seed", "1.5"}, "found 1.5");
}

TEST(CommandLine, usage_begins_with_the_program) {
  EXPECT_THAT(run_qsmpc({"--help"}).output, HasSubstr("Usage: qsmpc [OPTIONS]"));
  EXPECT_THAT(run_qsmpc({"run", "--help"}).output, HasSubstr("Usage: qsmpc run [OPTIONS]"));
  EXPECT_THAT(run_qsmpc({"campaign", "status", "--help"}).output,
              HasSubstr("Usage: qsmpc campaign status [OPTIONS]"));
}

TEST(CommandLine, help_is_a_command_as_well) {
  EXPECT_EQ(run_qsmpc({"help"}).output, run_qsmpc({"--help"}).output);
  EXPECT_EQ(run_qsmpc({"help", "run"}).output, run_qsmpc({"run", "--help"}).output);
  EXPECT_EQ(run_qsmpc({"help", "campaign", "status"}).output,
            run_qsmpc({"campaign", "status", "--help"}).output);
  expect_refused({"help", "rnu"}, "found rnu, expected run");
}

TEST(CommandLine, version_names_the_libraries) {
  const std::string text = run_qsmpc({"--version"}).output;
  EXPECT_THAT(text, StartsWith("qsmpc "));
  for (const char* line :
       {"\nMuJoCo 2.", "\nEigen 3.", "\nNLopt 2.", "\nHDF5 1.", "\nFFmpeg ", "\nSQLite 3."}) {
    EXPECT_THAT(text, HasSubstr(line));
  }
}

TEST(Init, writes_a_commented_scenario_that_is_valid_and_reaches_its_target) {
  const TemporaryFolder folder;
  const ProcessResult made = run_qsmpc({"init", "my_car"}, {.folder = folder.path()});
  ASSERT_EQ(made.exit_code, 0) << made.errors;
  EXPECT_THAT(made.output, HasSubstr("qsmpc run my_car.yaml"));
  EXPECT_THAT(read_text(folder / "my_car.yaml"), AllOf(HasSubstr("\n# "), HasSubstr("name: ")));
  const ProcessResult valid = run_qsmpc({"validate", folder / "my_car.yaml"});
  EXPECT_EQ(valid.exit_code, 0) << valid.output;
  EXPECT_THAT(valid.output, Not(HasSubstr("warning")));
  for (const char* seed : {"0", "1", "2"}) {
    const ProcessResult driven =
        run_qsmpc({"run", folder / "my_car.yaml", "--seed", seed, "--no-video", "--quiet", "--json",
                   "--force", "--out", folder / "out"});
    ASSERT_EQ(driven.exit_code, 0) << driven.errors;
    const auto summary = nlohmann::json::parse(driven.output);
    EXPECT_EQ(summary["scenario"], "my_car");
    EXPECT_EQ(summary["outcome"], "reached") << seed;
    EXPECT_EQ(summary["collision"], false) << seed;
    EXPECT_EQ(summary["risk"]["plan"]["exceeded"], 0) << seed;
  }
}

TEST(Export, writes_tables_beside_the_trace_or_into_the_given_folder) {
  const TemporaryFolder folder;
  const std::string out = folder / "out";
  ASSERT_EQ(run_qsmpc({"run", "dubins_corridor", "--set", "limit.steps=2", "--set",
                       "plant.kind=analytic", "--no-video", "--quiet", "--out", out})
                .exit_code,
            0);
  EXPECT_EQ(run_qsmpc({"export", out}).output, out + "/episode.csv\n" + out + "/plan.csv\n");
  EXPECT_THAT(read_text(out + "/episode.csv"), StartsWith("time [s],x [m],y [m],heading [rad]"));
  const std::string tables = folder / "tables";
  EXPECT_EQ(run_qsmpc({"export", out, "--particles", "--out", tables}).exit_code, 0);
  EXPECT_THAT(files_in(tables),
              ::testing::UnorderedElementsAre("episode.csv", "plan.csv", "particles.csv"));
  expect_refused({"export", folder / "nowhere"}, "expected a trace");
}

TEST(Init, replaces_nothing_and_takes_a_path) {
  const TemporaryFolder folder;
  const std::string file = folder.file("mine.yaml", "precious");
  expect_refused({"init", file}, "an existing file");
  EXPECT_EQ(read_text(file), "precious");
  std::filesystem::create_symlink(folder / "nowhere", folder / "link.yaml");
  expect_refused({"init", folder / "link.yaml"}, "an existing file");
  EXPECT_FALSE(std::filesystem::exists(folder / "nowhere"));
  EXPECT_EQ(run_qsmpc({"init"}, {.folder = folder.path()}).exit_code, 0);
  EXPECT_THAT(read_text(folder / "my_scenario.yaml"), HasSubstr("name: \"my_scenario\""));
}

}  // namespace command_line_test
}  // namespace qsmpc::harness
