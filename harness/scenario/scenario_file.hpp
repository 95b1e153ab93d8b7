// Scenario files: loaded and checked, or refused with place and reason; and written back.
//
//   Scenario scenario = load_scenario("dubins_obstacles", {"controller.horizon=12"});
//   write_file(folder + "/scenario.yaml", to_yaml(scenario));
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "harness/errors.hpp"
#include "harness/scenario/scenario.hpp"
#include "harness/scenario/yaml_tree.hpp"

#pragma GCC visibility push(default)

namespace qsmpc::harness {

/// The name of the resolved scenario among a command's output files.
inline constexpr const char* kScenarioFile = "scenario.yaml";

/// The origin of a scenario's text.
struct ScenarioSource {
  std::string file = "scenario";  ///< its name in errors
  std::string folder{};           ///< base of relative file paths; the current folder if empty
  std::vector<std::string> overrides{};  ///< KEY=VALUE, each as for --set, applied in order
  /// Whether a missing MuJoCo XML file is an error; otherwise its name is kept as written, for
  /// callers that only read a recorded scenario.
  bool files_must_exist = true;
  /// Whether a program wrote the text, in this or an earlier version: a vehicle without a footprint
  /// is then a point. Implied where files need not exist.
  bool is_recorded = false;
};

/// The path of the scenario `path_or_name`: a path, or the name of a shipped one. Throws InputError
/// when it is neither.
[[nodiscard]] std::string find_scenario(const std::string& path_or_name);

/// Loads a scenario file, given by its path or the name of a shipped one, with `overrides`
/// (KEY=VALUE) applied in order. Throws InputError with the first problem: its file ("--set" for an
/// override), line, key, what was found and what was expected.
[[nodiscard]] Scenario load_scenario(const std::string& path_or_name,
                                     const std::vector<std::string>& overrides = {});

/// A scenario file that is read once and can be loaded many times with different overrides.
class ScenarioBase {
 public:
  /// Throws InputError where there is no such file, or the file is not a valid tree of keys.
  explicit ScenarioBase(const std::string& path_or_name);

  /// As load_scenario.
  [[nodiscard]] Scenario load(const std::vector<std::string>& overrides) const;

 private:
  std::string path_;
  YamlNode tree_;
};

/// As load_scenario, from the text itself, e.g. from a trace.
[[nodiscard]] Scenario parse_scenario(const std::string& text, const ScenarioSource& source = {});

/// All problems of a scenario file with `overrides` applied, including an unreadable file; empty if
/// it is valid. At most 100 problems; if the file is not a valid tree of keys, only that one.
[[nodiscard]] std::vector<InputError::Where> validate_scenario_file(
    const std::string& path_or_name, const std::vector<std::string>& overrides = {});

/// The place of `key`, a dotted path, in a scenario file with `overrides` applied: `file` ("--set"
/// for an override) and `line` of the key, or of the nearest enclosing section that exists. Throws
/// InputError where there is no such file, or the file is not a valid tree of keys.
[[nodiscard]] InputError::Where place_of_key(const std::string& path_or_name,
                                             const std::vector<std::string>& overrides,
                                             const std::string& key);

/// The place where the mapping under `plant` names `element`, whose `kind` is "joint", "body",
/// "sensor", "actuator" or "site": as place_of_key, with `key`; nothing where it is not named.
[[nodiscard]] std::optional<InputError::Where> place_of_element(
    const std::string& path_or_name, const std::vector<std::string>& overrides,
    const std::string& kind, const std::string& element);

/// The scenario as a file with every key written out. Loading it gives the same values, bit for
/// bit. Equal scenarios give equal bytes. A shipped MuJoCo XML file is written by name, so that the
/// text contains no path of this machine; any other by its absolute path.
[[nodiscard]] std::string to_yaml(const Scenario& scenario);

}  // namespace qsmpc::harness

#pragma GCC visibility pop
