// Scenario files: loaded and checked, or refused with where and why; and written back.
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

/// What the resolved scenario is called among the files that a command leaves.
inline constexpr const char* kScenarioFile = "scenario.yaml";

/// Where a scenario's text comes from.
struct ScenarioSource {
  std::string file = "scenario";  ///< what errors call it
  std::string folder{};           ///< where its files are looked up; the current one if empty
  std::vector<std::string> overrides{};  ///< KEY=VALUE, each as after --set, applied in order
  /// Whether a MuJoCo XML file that is not found is refused; otherwise its name is kept as it is
  /// written, for those who only read a recorded scenario.
  bool files_must_exist = true;
  /// Whether the text is one that a program wrote, in this version or an earlier one: a vehicle
  /// without a footprint is then a point. So it is too where files need not exist.
  bool is_recorded = false;
};

/// The path of the scenario `path_or_name`: a path, or the name of a shipped one.
/// Throws InputError when it is neither.
[[nodiscard]] std::string find_scenario(const std::string& path_or_name);

/// Loads a scenario file, a path or the name of a shipped one, with `overrides` (KEY=VALUE) applied
/// in their order. Throws InputError with the first thing that is wrong: its file ("--set" for an
/// override), line, key, what was found and what is expected.
[[nodiscard]] Scenario load_scenario(const std::string& path_or_name,
                                     const std::vector<std::string>& overrides = {});

/// A scenario file that is read once, to be loaded many times with different overrides.
class ScenarioBase {
 public:
  /// Throws InputError where there is no such file, or no tree of keys in it.
  explicit ScenarioBase(const std::string& path_or_name);

  /// As load_scenario.
  [[nodiscard]] Scenario load(const std::vector<std::string>& overrides) const;

 private:
  std::string path_;
  YamlNode tree_;
};

/// As load_scenario, from the text itself, e.g. one that a trace holds.
[[nodiscard]] Scenario parse_scenario(const std::string& text, const ScenarioSource& source = {});

/// Everything that is wrong with a scenario file with `overrides` applied, the file being
/// unreadable included; empty if it is valid. At most 100 problems; after one that leaves no tree
/// of keys to look at, that one.
[[nodiscard]] std::vector<InputError::Where> validate_scenario_file(
    const std::string& path_or_name, const std::vector<std::string>& overrides = {});

/// Where `key`, a dotted path, stands in a scenario file with `overrides` applied: `file` ("--set"
/// for an override) and `line` of it, or of the nearest section around it that is there.
/// Throws InputError where there is no such file, or no tree of keys in it.
[[nodiscard]] InputError::Where place_of_key(const std::string& path_or_name,
                                             const std::vector<std::string>& overrides,
                                             const std::string& key);

/// Where the mapping under `plant` names `element`, a "joint", "body", "sensor", "actuator" or
/// "site" by its `kind`: as place_of_key, with `key`; none where it does not.
[[nodiscard]] std::optional<InputError::Where> place_of_element(
    const std::string& path_or_name, const std::vector<std::string>& overrides,
    const std::string& kind, const std::string& element);

/// The scenario as a file with every key written out. Loading it gives the same values, bit for
/// bit. The same scenario always gives the same bytes; a shipped MuJoCo XML file is written by its
/// name, so that no path of this machine is in it, any other by its absolute path.
[[nodiscard]] std::string to_yaml(const Scenario& scenario);

}  // namespace qsmpc::harness

#pragma GCC visibility pop
