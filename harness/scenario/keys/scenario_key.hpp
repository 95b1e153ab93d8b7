// A key of the scenario file: its description, and how it is read into a Scenario, checked and
// written. Most keys are one member of Scenario and need no functions:
//
//   {.about = {.name = "horizon",
//              .values = {WholeValue{1, kMostStages}},
//              .words = "steps that are planned ahead"},
//    .member = [](Scenario& scenario) -> int& { return scenario.controller.horizon; }}
//
// Its default is the member's value in Scenario{}.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <Eigen/Core>

#include "harness/scenario/keys/key_description.hpp"
#include "harness/scenario/scenario.hpp"
#include "harness/scenario/scenario_reader.hpp"
#include "harness/scenario/yaml_section.hpp"
#include "models/dynamics/dynamics.hpp"

namespace qsmpc::harness {

/// The state of a scenario that is being read.
struct ScenarioReading {
  const FileLookup& lookup;
  Problems& problems;
  Scenario scenario{};
  std::unique_ptr<const models::Dynamics> dynamics{};  ///< nullptr until the system is known

  [[nodiscard]] const models::SystemDescription& system() const { return dynamics->description(); }
};

/// The member of a scenario that a key holds; the monostate where it is not a single member.
using ScenarioMember =
    std::variant<std::monostate, bool& (*)(Scenario&), int& (*)(Scenario&),
                 std::uint64_t& (*)(Scenario&), double& (*)(Scenario&), std::string& (*)(Scenario&),
                 Eigen::VectorXd& (*)(Scenario&), Eigen::MatrixXd& (*)(Scenario&)>;

/// What must be read before a top-level key.
enum class ReadAfter { kNothing, kTimeStep, kSystem };

/// How a section is written: in braces on one line, or one key per line.
enum class SectionLayout { kFlow, kBlock };

struct ScenarioKey {
  KeyDescription about{};
  ScenarioMember member{};
  /// Replaces the default reading of the member: reads from the section that contains the key, and
  /// notes problems.
  void (*read)(ScenarioReading&, Section&, const KeyDescription&) = nullptr;
  /// Notes problems of a value that was read successfully, once all keys have been read.
  void (*check)(const ScenarioReading&, Section&) = nullptr;
  /// Replaces the default writing of the member: the value as YAML, or nothing where the key is
  /// left out. For a key that stands for several keys, all of them with their names.
  std::optional<std::string> (*write)(const Scenario&, const models::SystemDescription&) = nullptr;
  bool (*is_written)(const Scenario&) = nullptr;  ///< nullptr: always
  std::vector<ScenarioKey> keys{};                ///< of a section
  /// Of a section: a word that may replace it, and the word's meaning.
  std::string word{};
  void (*say)(Scenario&) = nullptr;
  SectionLayout layout = SectionLayout::kBlock;
  ReadAfter after = ReadAfter::kNothing;  ///< at the top level
  std::string table{};                    ///< the table of docs/scenario.md, at the top level
};

/// The keys of the parts of a scenario, in the order in which they are written.
[[nodiscard]] std::vector<ScenarioKey> experiment_keys();
[[nodiscard]] ScenarioKey time_step_key();
[[nodiscard]] ScenarioKey limit_key();
[[nodiscard]] ScenarioKey model_key();
[[nodiscard]] ScenarioKey plant_key();
[[nodiscard]] ScenarioKey initial_state_key();
[[nodiscard]] ScenarioKey disturbance_key();
[[nodiscard]] ScenarioKey model_error_key();
[[nodiscard]] ScenarioKey vehicle_key();
[[nodiscard]] ScenarioKey safe_set_key();
/// Subset: the obstacles and their other sources.
[[nodiscard]] std::vector<ScenarioKey> obstacle_keys();
[[nodiscard]] ScenarioKey target_key();
/// Subset: the keys of a path.
[[nodiscard]] std::vector<ScenarioKey> path_keys();
/// Subset: the keys of waypoints.
[[nodiscard]] std::vector<ScenarioKey> waypoint_keys();
[[nodiscard]] ScenarioKey risk_key();
[[nodiscard]] ScenarioKey estimator_key();
[[nodiscard]] ScenarioKey controller_key();
/// Subset of controller keys: the prediction.
[[nodiscard]] std::vector<ScenarioKey> prediction_keys();
/// The key of the sampling controllers.
[[nodiscard]] ScenarioKey mppi_key();
/// Subset of controller keys: controllers outside the program.
[[nodiscard]] std::vector<ScenarioKey> outside_controller_keys();
/// The key of the controllers with a chance constraint, and of the shield.
[[nodiscard]] ScenarioKey chance_key();
[[nodiscard]] ScenarioKey shield_key();
/// Notes a policy that the controller does not support.
void check_policy(const ScenarioReading& reading, Section& section);
[[nodiscard]] ScenarioKey video_key();

/// The keys of a whole scenario.
[[nodiscard]] const std::vector<ScenarioKey>& scenario_keys();

/// Notes a problem if `point`, the value of `key`, is outside the safe set, with obstacles at the
/// positions that the scenario states.
void check_safe(const ScenarioReading& reading, Section& section, const char* key,
                const Eigen::VectorXd& point, const controller::SafeSet& safe_set);
/// Notes a problem if the covariance under `key` has variances that are too small for certificates.
void check_variances(Section& section, const char* key, const Eigen::MatrixXd& covariance);

/// The description of `key`, with the keys of its section and its member's default.
[[nodiscard]] KeyDescription describe(const ScenarioKey& key);

}  // namespace qsmpc::harness
