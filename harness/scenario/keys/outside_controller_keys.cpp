// The keys of controllers outside the program. Under another kind they are read but have no effect,
// so that the same scenario can also be driven by another controller.
#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <sstream>
#include <system_error>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>
#include <unistd.h>

#include "harness/files/text_file.hpp"
#include "harness/scenario/keys/scenario_key.hpp"
#include "harness/scenario/outside_controllers.hpp"
#include "harness/scenario/yaml_json.hpp"
#include "harness/scenario/yaml_text.hpp"
#include "harness/text/json_text.hpp"

namespace qsmpc::harness {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostWords = 1000;  // of a command
// s; as for the deadline of a period.
constexpr NumberRange kStartRange{.least = 0.0, .most = 1e6, .above_least = true};

bool is_of_kind(const Scenario& scenario, const char* kind) {
  return scenario.controller.kind == kind;
}

/// `path` without "." and "..", relative to `folder` or, if that is empty, to the working folder.
fs::path absolute_path(const fs::path& folder, const std::string& path) {
  std::error_code error;
  fs::path normal = (fs::current_path(error) / folder / path).lexically_normal();
  return normal.has_filename() ? normal : normal.parent_path();
}

/// The base folder of the files in `words`, the value of `key`: the scenario's folder, or the
/// working folder where `words` came from the command line and none of them is in the scenario's.
fs::path folder_of(const ScenarioReading& reading, const Section& section, const std::string& key,
                   const std::vector<std::string>& words) {
  fs::path folder = reading.lookup.folder;
  if (!section.is_override(key)) return folder;
  const bool is_there = std::ranges::any_of(words, [&](const std::string& word) {
    return fs::path(word).is_relative() && is_file(folder / word);
  });
  return is_there ? folder : fs::path();
}

bool is_program(const fs::path& path) { return is_file(path) && ::access(path.c_str(), X_OK) == 0; }

/// Whether `word` names a program as execvp would find it from `folder`.
bool finds_program(const std::string& word, const fs::path& folder) {
  if (word.find('/') != std::string::npos) return is_program(folder / word);
  const char* const path = std::getenv("PATH");
  std::istringstream folders(path == nullptr ? "/bin:/usr/bin" : path);
  for (std::string one; std::getline(folders, one, ':');) {
    if (is_program((one.empty() ? folder : folder / one) / word)) return true;
  }
  return false;
}

void read_command(ScenarioReading& reading, Section& section, const KeyDescription& about) {
  std::vector<std::string>& command = reading.scenario.controller.outside.command;
  const std::size_t before = reading.problems.size();
  command = section.texts(about.name, kLongestPath);
  if (reading.problems.size() != before || !is_of_kind(reading.scenario, kExternalController)) {
    return;
  }
  if (command.empty() || command.front().empty()) {
    section.note(about.name, "[PROGRAM, ARGUMENT, …], because controller.kind is external");
  } else if (command.size() > kMostWords) {
    section.note(about.name, "at most 1000 words");
  }
}

void check_command(const ScenarioReading& reading, Section& section) {
  const Scenario::OutsideController& outside = reading.scenario.controller.outside;
  if (!reading.lookup.must_exist || !is_of_kind(reading.scenario, kExternalController)) return;
  if (finds_program(outside.command.front(), outside.folder)) return;
  section.note("command",
               "a program on the PATH or, with a slash in its name, in " + outside.folder,
               "no program " + outside.command.front());
}

std::optional<std::string> command_text(const Scenario& scenario,
                                        const models::SystemDescription& /*system*/) {
  if (!is_of_kind(scenario, kExternalController) && !is_of_kind(scenario, kObjectController)) {
    return std::nullopt;
  }
  std::string text;
  for (const std::string& word : scenario.controller.outside.command) {
    text += (text.empty() ? "" : ", ") + quoted_yaml(word);
  }
  return "[" + text + "]";
}

void read_folder(ScenarioReading& reading, Section& section, const KeyDescription& about) {
  const std::string given = section.text(about.name, "", kLongestPath);
  const fs::path begin =
      section.has(about.name)
          ? folder_of(reading, section, about.name, {})
          : folder_of(reading, section, "command", reading.scenario.controller.outside.command);
  const fs::path folder = absolute_path(begin, given);
  reading.scenario.controller.outside.folder = folder.string();
  std::error_code error;
  const bool is_needed =
      reading.lookup.must_exist && is_of_kind(reading.scenario, kExternalController);
  if (is_needed && !fs::is_directory(folder, error)) {
    section.note(about.name, "a folder", "no folder " + folder.string());
  }
}

std::optional<std::string> folder_text(const Scenario& scenario,
                                       const models::SystemDescription& /*system*/) {
  if (!is_of_kind(scenario, kExternalController)) return std::nullopt;
  return quoted_yaml(scenario.controller.outside.folder);
}

void read_library(ScenarioReading& reading, Section& section, const KeyDescription& about) {
  const std::string name = section.text(about.name, "", kLongestPath);
  const bool is_needed = is_of_kind(reading.scenario, kLibraryController);
  if (name.empty()) {
    if (is_needed) section.note(about.name, "a shared library, because controller.kind is library");
    return;
  }
  const fs::path path = absolute_path(folder_of(reading, section, about.name, {name}), name);
  reading.scenario.controller.outside.library = path.string();
  if (is_needed && reading.lookup.must_exist && !is_file(path)) {
    section.note(about.name, "a shared library", "no file " + path.string());
  }
}

std::optional<std::string> library_text(const Scenario& scenario,
                                        const models::SystemDescription& /*system*/) {
  if (!is_of_kind(scenario, kLibraryController)) return std::nullopt;
  return quoted_yaml(scenario.controller.outside.library);
}

void read_options(ScenarioReading& reading, Section& section, const KeyDescription& about) {
  const YamlNode* const node = section.tree(about.name);
  if (node == nullptr) return;
  if (node->kind != YamlNode::Kind::kMap) {
    section.note(about.name, "a mapping of keys to values");
    return;
  }
  const std::optional<nlohmann::ordered_json> options = json_of(*node);
  if (options) {
    reading.scenario.controller.outside.options = compact_json_text(*options);
  } else {
    section.note(about.name, "finite numbers, because the options are passed on as JSON",
                 "a number that is not finite");
  }
}

std::optional<std::string> options_text(const Scenario& scenario,
                                        const models::SystemDescription& /*system*/) {
  const std::string& options = scenario.controller.outside.options;
  if (!is_outside(scenario.controller) || options == "{}") return std::nullopt;
  return options;  // JSON is YAML
}

bool is_of_outside(const Scenario& scenario) { return is_outside(scenario.controller); }

}  // namespace

std::vector<ScenarioKey> outside_controller_keys() {
  return {
      {.about = {.name = "command",
                 .values = {list_of_values(TextValue{}, {.least = 1, .most = kMostWords})},
                 .words = "for `external`: the program and its arguments; for `object`: its name",
                 .see = "[controllers](controllers.md)",
                 .fallback_words = "required by it"},
       .read = read_command,
       .check = check_command,
       .write = command_text},
      {.about = {.name = "folder",
                 .values = {TextValue{}},
                 .words =
                     "for `external`: its working folder, absolute or relative to the scenario's",
                 .fallback_words = "the scenario's; the working folder where `command` is given "
                                   "with `--set` and names no file there"},
       .read = read_folder,
       .write = folder_text},
      {.about = {.name = "library",
                 .values = {TextValue{}},
                 .words = "for `library`: the shared library, absolute or relative to the "
                          "scenario's folder (with `--set`, otherwise to the working folder)",
                 .see = "[controllers](controllers.md)",
                 .fallback_words = "required by it"},
       .read = read_library,
       .write = library_text},
      {.about = {.name = "options",
                 .values = {MappingValue{
                     {{.name = "OPTION", .family = NameFamily::kFree, .values = {AnyValue{}}}}}},
                 .words =
                     "for `external` and `library`: settings for the controller, passed on as JSON",
                 .fallback_words = "none"},
       .read = read_options,
       .write = options_text},
      {.about = {.name = "plans",
                 .values = {FlagValue{}},
                 .words = "for `external`, `library` and `object`: whether every answer has a plan "
                          "of `horizon` stages, which is certified"},
       .member = [](Scenario& scenario) -> bool& { return scenario.controller.outside.plans; },
       .is_written = is_of_outside},
      {.about = {.name = "start_deadline",
                 .values = {NumberValue{kStartRange}},
                 .words =
                     "for `external` and `library`: maximum time until the controller is ready",
                 .unit = "s"},
       .member = [](Scenario& scenario) -> double& {
         return scenario.controller.outside.start_deadline;
       },
       .is_written = is_of_outside},
  };
}

}  // namespace qsmpc::harness
