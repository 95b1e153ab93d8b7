// Where the models, scenarios and campaigns are that come with the program.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace qsmpc::harness {

/// An experiment that comes with the program.
struct ShippedFile {
  std::string name;         ///< as it is given on the command line
  std::string description;  ///< one line, from the file; empty where that cannot be read
  std::string path;
};
using ShippedScenario = ShippedFile;
using ShippedCampaign = ShippedFile;
using ShippedContest = ShippedFile;

/// The folder of shipped models, with `campaigns`, `contests`, `scenarios` and `mjcf` in it: the
/// environment variable QSMPC_MODELS where it is set, else ../share/qsmpc/models beside the
/// program, else the source tree's.
[[nodiscard]] std::string shipped_models_folder();

/// All of them, by name; empty where the folder cannot be read.
[[nodiscard]] std::vector<ShippedScenario> shipped_scenarios();

/// Their names only, without reading the files.
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

/// Files that are shipped by name.
enum class ShippedKind { kScenario, kCampaign, kContest };

/// `path_or_name` where it is a file, else the path of the shipped file of that name, else again
/// `path_or_name` where it looks like a path, so that reading it says what is wrong with it.
/// Throws InputError where it is none of them.
[[nodiscard]] std::string find_file_or_shipped(const std::string& path_or_name, ShippedKind kind);

/// Absolute path of the MuJoCo XML file `name`: an absolute path as it is, else relative to
/// `scenario_folder`, else among the shipped ones. Empty if there is no such file.
[[nodiscard]] std::string find_mjcf(const std::string& name, const std::string& scenario_folder);

/// What `find_mjcf` finds `path` again by, on any machine where that is possible: the shipped name
/// of a shipped file, otherwise `path` itself.
[[nodiscard]] std::string mjcf_name(const std::string& path);

}  // namespace qsmpc::harness
