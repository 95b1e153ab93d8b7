// The locations of the shipped models, scenarios and campaigns.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace qsmpc::harness {

/// A shipped experiment.
struct ShippedFile {
  std::string name;         ///< as given on the command line
  std::string description;  ///< one line, from the file; empty where the file cannot be read
  std::string path;
};
using ShippedScenario = ShippedFile;
using ShippedCampaign = ShippedFile;
using ShippedContest = ShippedFile;

/// The folder of shipped models, which contains `campaigns`, `contests`, `scenarios` and `mjcf`:
/// the environment variable QSMPC_MODELS if set, else ../share/qsmpc/models beside the program,
/// else the source tree's.
[[nodiscard]] std::string shipped_models_folder();

/// All shipped scenarios, by name; empty where the folder cannot be read.
[[nodiscard]] std::vector<ShippedScenario> shipped_scenarios();

/// Only their names, without reading the files.
[[nodiscard]] std::vector<std::string> shipped_scenario_names();

/// As for scenarios.
[[nodiscard]] std::vector<ShippedCampaign> shipped_campaigns();
[[nodiscard]] std::vector<std::string> shipped_campaign_names();
[[nodiscard]] std::vector<ShippedContest> shipped_contests();

/// The names of the shipped MuJoCo XML files, e.g. "dubins_car.xml".
[[nodiscard]] std::vector<std::string> shipped_mjcf_names();

/// The path of the shipped scenario called `name`, or nothing.
[[nodiscard]] std::optional<std::string> find_shipped_scenario(const std::string& name);

/// The path of the shipped campaign called `name`, or nothing.
[[nodiscard]] std::optional<std::string> find_shipped_campaign(const std::string& name);

/// The path of the shipped contest called `name`, or nothing.
[[nodiscard]] std::optional<std::string> find_shipped_contest(const std::string& name);

/// The kinds of files that are shipped by name.
enum class ShippedKind { kScenario, kCampaign, kContest };

/// `path_or_name` where it is a file; else the path of the shipped file of that name; else
/// `path_or_name` again where it looks like a path, so that the error comes from reading it. Throws
/// InputError otherwise.
[[nodiscard]] std::string find_file_or_shipped(const std::string& path_or_name, ShippedKind kind);

/// Absolute path of the MuJoCo XML file `name`: an absolute path is kept, a relative one is looked
/// up in `scenario_folder`, then among the shipped files. Empty if there is no such file.
[[nodiscard]] std::string find_mjcf(const std::string& name, const std::string& scenario_folder);

/// The name by which `find_mjcf` finds `path` again, where possible on any machine: the name of a
/// shipped file, otherwise `path` itself.
[[nodiscard]] std::string mjcf_name(const std::string& path);

}  // namespace qsmpc::harness
