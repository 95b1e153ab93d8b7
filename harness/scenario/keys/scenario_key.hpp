// A key of the scenario file: its description, and how it is read into a Scenario, checked and
// written. Most are one member of Scenario, and need no function:
//
//   {.about = {.name = "horizon",
//              .values = {WholeValue{1, kMostStages}},
//              .words = "steps that are planned ahead"},
//    .member = [](Scenario& scenario) -> int& { return scenario.controller.horizon; }}
//
// Its default is what the member has in Scenario{}.
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

/// What is known while a scenario is read.
struct ScenarioReading {
  const FileLookup& lookup;
  Problems& problems;
  Scenario scenario{};
  std::unique_ptr<const models::Dynamics> dynamics{};  ///< nullptr while the system is not known

  [[nodiscard]] const models::SystemDescription& system() const { return dynamics->description(); }
};

/// The member of a scenario that a key holds; the monostate where it is not a single one.
using ScenarioMember =
    std::variant<std::monostate, bool& (*)(Scenario&), int& (*)(Scenario&),
                 std::uint64_t& (*)(Scenario&), double& (*)(Scenario&), std::string& (*)(Scenario&),
                 Eigen::VectorXd& (*)(Scenario&), Eigen::MatrixXd& (*)(Scenario&)>;

/// What a top-level key is read after.
enum class ReadAfter { kNothing, kTimeStep, kSystem };

/// How a section is written: in braces on one line, or a key a line.
enum class SectionLayout { kFlow, kBlock };

struct ScenarioKey {
  KeyDescription about{};
  ScenarioMember member{};
  /// Instead of reading the member: from the section that the key is in. Notes what is wrong.
  void (*read)(ScenarioReading&, Section&, const KeyDescription&) = nullptr;
  /// Notes what is wrong with a value that was read well, once all keys were read.
  void (*check)(const ScenarioReading&, Section&) = nullptr;
  /// Instead of writing the member: the value as YAML, nothing where the key is left out. Of a key
  /// that stands for several ones, all of them with their names.
  std::optional<std::string> (*write)(const Scenario&, const models::SystemDescription&) = nullptr;
  bool (*is_written)(const Scenario&) = nullptr;  ///< nullptr: always
  std::vector<ScenarioKey> keys{};                ///< of a section
  /// Of a section: a word that may stand in its place, and what it says.
  std::string word{};
  void (*say)(Scenario&) = nullptr;
  SectionLayout layout = SectionLayout::kBlock;
  ReadAfter after = ReadAfter::kNothing;  ///< at the top level
  std::string table{};                    ///< of docs/scenario.md, at the top level
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
/// Within it, the obstacles and where else they are from.
[[nodiscard]] std::vector<ScenarioKey> obstacle_keys();
[[nodiscard]] ScenarioKey target_key();
/// Within it, those of a path.
[[nodiscard]] std::vector<ScenarioKey> path_keys();
/// And those of waypoints.
[[nodiscard]] std::vector<ScenarioKey> waypoint_keys();
[[nodiscard]] ScenarioKey risk_key();
[[nodiscard]] ScenarioKey estimator_key();
[[nodiscard]] ScenarioKey controller_key();
/// Within it, those of what it predicts with.
[[nodiscard]] std::vector<ScenarioKey> prediction_keys();
/// Those of controllers that sample.
[[nodiscard]] ScenarioKey mppi_key();
/// Within it, those of controllers that are no part of the program.
[[nodiscard]] std::vector<ScenarioKey> outside_controller_keys();
/// Those of controllers that keep a chance constraint, and of the shield.
[[nodiscard]] ScenarioKey chance_key();
[[nodiscard]] ScenarioKey shield_key();
/// Notes a policy that the controller does not know.
void check_policy(const ScenarioReading& reading, Section& section);
[[nodiscard]] ScenarioKey video_key();

/// All of them.
[[nodiscard]] const std::vector<ScenarioKey>& scenario_keys();

/// Notes that `point`, the value of `key`, is not in the safe set where obstacles stand as they are
/// written.
void check_safe(const ScenarioReading& reading, Section& section, const char* key,
                const Eigen::VectorXd& point, const controller::SafeSet& safe_set);
/// Notes that the value of `key`, a covariance, has variances too small for certificates.
void check_variances(Section& section, const char* key, const Eigen::MatrixXd& covariance);

/// `key` with the keys of its section, and its member's default.
[[nodiscard]] KeyDescription describe(const ScenarioKey& key);

}  // namespace qsmpc::harness
