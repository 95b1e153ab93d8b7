#include "harness/cli/result_folder.hpp"

#include <filesystem>
#include <map>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "harness/campaign/store/store_schema.hpp"
#include "harness/errors.hpp"
#include "harness/files/text_file.hpp"
#include "harness/scenario/scenario_file.hpp"
#include "harness/scenario/yaml_text.hpp"
#include "harness/scenario/yaml_tree.hpp"

namespace qsmpc::harness {
namespace {

constexpr std::size_t kLongestValue = 60;  // of a value shown in a message

using Values = std::map<std::string, std::string>;  // by dotted key

void collect(const YamlNode& node, const std::string& path, Values& values) {
  if (node.kind != YamlNode::Kind::kMap) {
    values.emplace(path, yaml_flow(node));
    return;
  }
  for (std::size_t i = 0; i < node.items.size(); ++i) {
    const std::string& key = node.keys[i];
    if (path.empty() && (key == "name" || key == "description")) continue;
    std::string inner = path;
    if (!inner.empty()) inner += '.';
    inner += key;
    collect(node.items[i], inner, values);
  }
}

Values values_of(const std::string& yaml) {
  Values values;
  collect(parse_yaml(yaml, kScenarioFile), "", values);
  return values;
}

std::string shown(const Values& values, const std::string& key) {
  const auto at = values.find(key);
  if (at == values.end()) return "not set";
  return at->second.size() <= kLongestValue ? at->second : "another value";
}

bool is_there(const std::string& path) {
  std::error_code ignored;
  return std::filesystem::exists(path, ignored);
}

[[noreturn]] void refuse(const std::string& folder, std::string found) {
  throw InputError({.file = folder,
                    .found = std::move(found),
                    .expected = "another --out, or --force to replace it"});
}

}  // namespace

void add_force_option(CLI::App& command, bool& force) {
  command.add_flag("--force", force,
                   "replace results in the output folder, even those of another scenario");
}

std::string scenario_difference(const std::string& there, const std::string& here) {
  const Values old_values = values_of(there);
  const Values new_values = values_of(here);
  std::vector<std::string> differing;
  for (const auto& [key, value] : new_values) {
    const auto at = old_values.find(key);
    if (at == old_values.end() || at->second != value) differing.push_back(key);
  }
  for (const auto& [key, value] : old_values) {
    if (!new_values.contains(key)) differing.push_back(key);
  }
  if (differing.empty()) return "";
  std::string words =
      fmt::format("{} is {} there, {} here", differing.front(),
                  shown(old_values, differing.front()), shown(new_values, differing.front()));
  if (const std::size_t more = differing.size() - 1; more > 0) {
    words += fmt::format(", and {} more {}", more, more == 1 ? "key differs" : "keys differ");
  }
  return words;
}

void refuse_other_result(const std::string& folder, const Scenario& scenario, bool force) {
  if (force) return;
  if (is_there(folder + "/" + kStoreFile)) refuse(folder, "the results of a campaign");
  const std::string file = folder + "/" + kScenarioFile;
  if (!is_there(file)) return;
  std::string difference;
  try {
    difference = scenario_difference(read_text_file(file), to_yaml(scenario));
  } catch (const InputError&) {
    refuse(folder, std::string("a ") + kScenarioFile + " that is not a resolved scenario");
  }
  if (!difference.empty()) refuse(folder, "the result of another scenario: " + difference);
}

}  // namespace qsmpc::harness
