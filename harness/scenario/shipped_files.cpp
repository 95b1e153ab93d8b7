#include "harness/scenario/shipped_files.hpp"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <stdexcept>
#include <system_error>

#include "harness/errors.hpp"
#include "harness/files/installation.hpp"
#include "harness/files/text_file.hpp"
#include "harness/scenario/known_names.hpp"
#include "harness/scenario/yaml_tree.hpp"
#include "harness/text/printable.hpp"

namespace qsmpc::harness {
namespace {

namespace fs = std::filesystem;

constexpr const char* kScenarios = "scenarios";
constexpr const char* kCampaigns = "campaigns";
constexpr const char* kContests = "contests";

// `path` without "..", with links resolved as far as it exists; never throws.
fs::path normal(const fs::path& path) {
  std::error_code error;
  fs::path canonical = fs::weakly_canonical(path, error);
  return error ? path.lexically_normal() : canonical;
}

// PREFIX/share/qsmpc/models; empty where the program is not installed.
fs::path installed_models_folder() {
  std::error_code error;
  for (const std::string& prefix : installation_prefixes()) {
    fs::path models = fs::path(prefix) / "share" / "qsmpc" / "models";
    if (fs::is_directory(models, error)) return models;
  }
  return {};
}

// The files with the given extension in a folder of the shipped models, by name.
std::vector<fs::path> shipped_in(const char* folder, const char* extension) {
  std::vector<fs::path> paths;
  std::error_code error;
  fs::directory_iterator at(fs::path(shipped_models_folder()) / folder, error);
  for (; !error && at != fs::directory_iterator(); at.increment(error)) {
    if (at->path().extension() == extension && is_file(at->path())) paths.push_back(at->path());
  }
  std::sort(paths.begin(), paths.end());
  return paths;
}

std::string description_in(const std::string& path) {
  try {
    const YamlNode tree = parse_yaml(read_text_file(path), path);
    const YamlNode* node = tree.find("description");
    return node == nullptr ? "" : printable(node->text, 200);
  } catch (const InputError&) {
    return "";  // `qsmpc validate` reports the problem; a list of names should not fail over it
  }
}

std::vector<std::string> shipped_names(const char* folder) {
  std::vector<std::string> names;
  for (const fs::path& path : shipped_in(folder, ".yaml")) names.push_back(path.stem());
  return names;
}

std::optional<std::string> find_shipped(const char* folder, const std::string& name) {
  if (name.empty() || name.find('/') != std::string::npos) return std::nullopt;
  const fs::path path = fs::path(shipped_models_folder()) / folder / (name + ".yaml");
  return is_file(path) ? std::optional(path.string()) : std::nullopt;
}

std::vector<ShippedFile> shipped_files(const char* folder) {
  std::vector<ShippedFile> files;
  for (const std::string& name : shipped_names(folder)) {
    if (const auto path = find_shipped(folder, name)) {
      files.push_back({.name = name, .description = description_in(*path), .path = *path});
    }
  }
  return files;
}

/// The folder of a kind of files, and the word for one of them.
struct KindWords {
  const char* folder;
  const char* what;
};

const KindWords& words_of(ShippedKind kind) {
  static const KindWords scenario{.folder = kScenarios, .what = "scenario"};
  static const KindWords campaign{.folder = kCampaigns, .what = "campaign"};
  static const KindWords contest{.folder = kContests, .what = "contest"};
  switch (kind) {
    case ShippedKind::kScenario:
      return scenario;
    case ShippedKind::kCampaign:
      return campaign;
    case ShippedKind::kContest:
      return contest;
  }
  throw std::invalid_argument("shipped files: a kind that has no name");
}

}  // namespace

std::string shipped_models_folder() {
  // NOLINTNEXTLINE(concurrency-mt-unsafe): the program never changes its environment.
  const char* given = std::getenv("QSMPC_MODELS");
  std::error_code error;
  if (given != nullptr && *given != '\0') return normal(fs::absolute(given, error)).string();
  const fs::path installed = installed_models_folder();
  if (!installed.empty()) return normal(installed).string();
  return normal(QSMPC_SOURCE_MODELS_DIR).string();
}

std::vector<std::string> shipped_scenario_names() { return shipped_names(kScenarios); }

std::vector<std::string> shipped_campaign_names() { return shipped_names(kCampaigns); }

std::vector<std::string> shipped_mjcf_names() {
  std::vector<std::string> names;
  for (const fs::path& path : shipped_in("mjcf", ".xml")) names.push_back(path.filename());
  return names;
}

std::vector<ShippedScenario> shipped_scenarios() { return shipped_files(kScenarios); }

std::vector<ShippedCampaign> shipped_campaigns() { return shipped_files(kCampaigns); }

std::vector<ShippedContest> shipped_contests() { return shipped_files(kContests); }

std::optional<std::string> find_shipped_scenario(const std::string& name) {
  return find_shipped(kScenarios, name);
}

std::optional<std::string> find_shipped_campaign(const std::string& name) {
  return find_shipped(kCampaigns, name);
}

std::optional<std::string> find_shipped_contest(const std::string& name) {
  return find_shipped(kContests, name);
}

std::string find_file_or_shipped(const std::string& path_or_name, ShippedKind kind) {
  const KindWords& words = words_of(kind);
  const char* const folder = words.folder;
  if (is_file(path_or_name)) return path_or_name;
  if (const auto shipped = find_shipped(folder, path_or_name)) return *shipped;
  std::error_code error;
  const std::string extension = fs::path(path_or_name).extension().string();
  const bool is_path = path_or_name.find('/') != std::string::npos || extension == ".yaml" ||
                       extension == ".yml" || fs::exists(path_or_name, error);
  if (is_path) return path_or_name;
  const std::string what = words.what;
  throw InputError({.file = path_or_name,
                    .found = "no such file or shipped " + what,
                    .expected = "the path of a " + what + " file, or " +
                                expected_names(path_or_name, shipped_names(folder))});
}

std::string find_mjcf(const std::string& name, const std::string& scenario_folder) {
  if (name.empty()) return "";
  const fs::path given(name);
  const fs::path folder = scenario_folder.empty() ? fs::path(".") : fs::path(scenario_folder);
  std::error_code error;
  const fs::path beside = fs::absolute(given.is_absolute() ? given : folder / given, error);
  if (!error && is_file(beside)) return normal(beside).string();
  if (given.is_absolute()) return "";
  const fs::path shipped = fs::path(shipped_models_folder()) / "mjcf" / given;
  return is_file(shipped) ? normal(shipped).string() : "";
}

std::string mjcf_name(const std::string& path) {
  if (path.empty()) return path;
  const fs::path folder = normal(fs::path(shipped_models_folder()) / "mjcf");
  const fs::path relative = normal(path).lexically_relative(folder);
  const bool is_inside = !relative.empty() && *relative.begin() != ".." && relative != ".";
  return is_inside ? relative.string() : path;
}

}  // namespace qsmpc::harness
