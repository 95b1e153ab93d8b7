#include "harness/scenario/scenario_file.hpp"

#include <algorithm>
#include <cstddef>
#include <filesystem>

#include "harness/scenario/overrides.hpp"
#include "harness/scenario/scenario_reader.hpp"
#include "harness/scenario/shipped_files.hpp"
#include "harness/scenario/yaml_section.hpp"
#include "harness/scenario/yaml_tree.hpp"

namespace qsmpc::harness {
namespace {

namespace fs = std::filesystem;

Scenario read_text(const std::string& text, const ScenarioSource& source, Problems& problems) {
  YamlNode tree = parse_yaml(text, source.file);
  for (const std::string& override : source.overrides) apply_override(tree, override);
  return read_scenario(tree,
                       {.folder = source.folder,
                        .must_exist = source.files_must_exist,
                        .is_recorded = source.is_recorded || !source.files_must_exist},
                       problems);
}

std::string folder_of(const std::string& path) { return fs::path(path).parent_path().string(); }

}  // namespace

std::string find_scenario(const std::string& path_or_name) {
  return find_file_or_shipped(path_or_name, ShippedKind::kScenario);
}

Scenario load_scenario(const std::string& path_or_name, const std::vector<std::string>& overrides) {
  const std::string path = find_scenario(path_or_name);
  return parse_scenario(read_text_file(path),
                        {.file = path, .folder = folder_of(path), .overrides = overrides});
}

Scenario parse_scenario(const std::string& text, const ScenarioSource& source) {
  Problems problems(source.file);
  Scenario scenario = read_text(text, source, problems);
  if (!problems.empty()) throw InputError(problems.sorted().front());
  return scenario;
}

std::vector<InputError::Where> validate_scenario_file(const std::string& path_or_name,
                                                      const std::vector<std::string>& overrides) {
  try {
    const std::string path = find_scenario(path_or_name);
    Problems problems(path);
    (void)read_text(read_text_file(path),
                    {.file = path, .folder = folder_of(path), .overrides = overrides}, problems);
    return problems.sorted();
  } catch (const InputError& error) {
    return {error.where()};
  }
}

InputError::Where place_of_key(const std::string& path_or_name,
                               const std::vector<std::string>& overrides, const std::string& key) {
  const std::string path = find_scenario(path_or_name);
  YamlNode tree = parse_yaml(read_text_file(path), path);
  for (const std::string& override : overrides) apply_override(tree, override);
  const YamlNode* nearest = &tree;
  for (std::size_t begin = 0; begin < key.size();) {
    const std::size_t end = std::min(key.find('.', begin), key.size());
    const YamlNode* next = nearest->find(key.substr(begin, end - begin));
    if (next == nullptr) break;
    nearest = next;
    begin = end + 1;
  }
  if (nearest->from_override) return {.file = kOverrideSource};
  return {.file = path, .line = nearest->key_line > 0 ? nearest->key_line : nearest->line};
}

}  // namespace qsmpc::harness
