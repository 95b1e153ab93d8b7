// The keys of external controllers: the base of their paths, refusals, and options that are written
// back as read.
#include <filesystem>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "harness/scenario/known_names.hpp"
#include "harness/scenario/outside_controllers.hpp"
#include "harness/scenario/scenario_file.hpp"
#include "harness/scenario/yaml_json.hpp"
#include "tests/unit/scenario/scenario_fixture.hpp"
#include "tests/unit/scenario/scenario_round_trip.hpp"

namespace qsmpc::harness {
namespace outside_controller_keys_test {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;

const std::string kExternal =
    "controller: {kind: external, command: [python3, my.py, '5'], options: {a: 1.5, b: [x, \"2\", "
    "{c: null}], \"d e\": \"q\\\"uote: é\", f: true, g: -3}, plans: true, start_deadline: 2.5}\n";

Scenario in_folder(const std::string& text, const std::string& folder) {
  return parse_scenario(minimal_text + text, {.file = "t.yaml", .folder = folder});
}

TEST(OutsideControllerKeys, are_read_and_written_back_as_they_were) {
  const Scenario scenario = in_folder(kExternal, "/tmp");
  const Scenario::OutsideController& outside = scenario.controller.outside;
  EXPECT_EQ(outside.command, (std::vector<std::string>{"python3", "my.py", "5"}));
  EXPECT_EQ(outside.folder, "/tmp");
  EXPECT_EQ(
      nlohmann::json::parse(outside.options),
      nlohmann::json::parse(
          R"({"a": 1.5, "b": ["x", "2", {"c": null}], "d e": "q\"uote: é", "f": true, "g": -3})"));
  EXPECT_TRUE(outside.plans);
  expect_round_trip(scenario);
  const Scenario again = parse_scenario(to_yaml(scenario));
  EXPECT_EQ(again.controller.outside.command, outside.command);
  EXPECT_EQ(again.controller.outside.folder, outside.folder);
  EXPECT_EQ(again.controller.outside.options, outside.options);
  EXPECT_EQ(again.controller.outside.start_deadline, 2.5);
}

TEST(OutsideControllerKeys,
     have_paths_that_begin_at_the_scenario_or_on_the_command_line_where_one_is) {
  const std::string here = std::filesystem::current_path();
  EXPECT_EQ(in_folder(kExternal, "/tmp/..").controller.outside.folder, "/");
  EXPECT_EQ(in_folder(kExternal, "").controller.outside.folder, here);
  const Scenario given =
      minimal_with({"controller.kind=external", "controller.command=[python3, my.py]"});
  EXPECT_EQ(given.controller.outside.folder, here);
  const testing::TemporaryFolder folder;
  (void)folder.file("mpc.so", "");
  const std::string library = "controller: {kind: library, library: mpc.so}\n";
  const Scenario scenario = in_folder(library, folder.path());
  EXPECT_EQ(scenario.controller.outside.library, folder / "mpc.so");
  expect_round_trip(scenario);
  EXPECT_THAT(refusal_of(minimal_text + library).found, HasSubstr("no file " + here + "/mpc.so"));
}

TEST(OutsideControllerKeys, are_refused_where_nothing_can_be_started) {
  const auto refused = [](const std::string& controller) {
    return refusal_of(minimal_text + "controller: " + controller + "\n");
  };
  EXPECT_EQ(refused("{kind: external}").key, "controller.command");
  EXPECT_EQ(refused("{kind: external, command: ['']}").key, "controller.command");
  EXPECT_EQ(refused("{kind: external, command: [no_such_program]}").found,
            "no program no_such_program");
  EXPECT_EQ(refused("{kind: external, command: [./no_such_program]}").key, "controller.command");
  EXPECT_EQ(refused("{kind: external, command: [python3], folder: /no/such}").key,
            "controller.folder");
  EXPECT_EQ(refused("{kind: library}").key, "controller.library");
  EXPECT_EQ(refused("{kind: external, command: [python3], options: {a: .nan}}").key,
            "controller.options");
  EXPECT_EQ(refused("{kind: external, command: [python3], options: 3}").key, "controller.options");
  EXPECT_EQ(refused("{kind: external, command: [python3], start_deadline: 0}").key,
            "controller.start_deadline");
  EXPECT_THAT(refused("{kind: extern}").expected, HasSubstr("external"));
}

TEST(OutsideControllerKeys, of_a_recorded_scenario_may_name_what_is_gone) {
  const std::string text =
      minimal_text + "controller: {kind: external, command: [no_such_program], folder: /no}\n";
  const Scenario scenario = parse_scenario(text, {.file = "t.yaml", .files_must_exist = false});
  EXPECT_EQ(scenario.controller.outside.folder, "/no");
}

TEST(OutsideControllerKeys, have_no_effect_under_another_kind_and_are_not_written) {
  const Scenario scenario = parse_scenario(
      minimal_text + kExternal, {.file = "t.yaml", .overrides = {"controller.kind=lqr"}});
  EXPECT_EQ(scenario.controller.kind, "lqr");
  EXPECT_THAT(to_yaml(scenario), Not(HasSubstr("my.py")));
  expect_round_trip(scenario);
}

TEST(OutsideControllerKeys, have_names_beside_those_of_the_programs_own_controllers) {
  for (const OutsideControllerEntry& entry : outside_controllers()) {
    EXPECT_THAT(controller_names(), Contains(entry.name));
  }
}

TEST(OutsideControllerKeys, have_an_answer_deadline_whether_or_not_plans_have_one) {
  EXPECT_EQ(answer_deadline(minimal_with({}).controller), 10.0);
  EXPECT_EQ(answer_deadline(minimal_with({"controller.deadline=0.1"}).controller), 0.1);
}

}  // namespace outside_controller_keys_test
}  // namespace qsmpc::harness
