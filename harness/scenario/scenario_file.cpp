#include "harness/scenario/scenario_file.hpp"

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <optional>
#include <utility>

#include "harness/scenario/overrides.hpp"
#include "harness/scenario/scenario_reader.hpp"
#include "harness/scenario/shipped_files.hpp"
#include "harness/scenario/yaml_section.hpp"
#include "harness/scenario/yaml_tree.hpp"

namespace qsmpc::harness {
namespace {

namespace fs = std::filesystem;

Scenario read_tree(YamlNode tree, const ScenarioSource& source, Problems& problems) {
  for (const std::string& override : source.overrides) apply_override(tree, override);
  return read_scenario(tree,
                       {.folder = source.folder,
                        .must_exist = source.files_must_exist,
                        .is_recorded = source.is_recorded || !source.files_must_exist},
                       problems);
}

Scenario read_text(const std::string& text, const ScenarioSource& source, Problems& problems) {
  return read_tree(parse_yaml(text, source.file), source, problems);
}

Scenario unless_refused(Scenario scenario, const Problems& problems) {
  if (!problems.empty()) throw InputError(problems.sorted().front());
  return scenario;
}

std::string folder_of(const std::string& path) { return fs::path(path).parent_path().string(); }

YamlNode overridden_tree(const std::string& path, const std::vector<std::string>& overrides) {
  YamlNode tree = parse_yaml(read_text_file(path), path);
  for (const std::string& override : overrides) apply_override(tree, override);
  return tree;
}

InputError::Where place_of(const std::string& path, const std::string& key, const YamlNode& node) {
  if (node.from_override) return {.file = kOverrideSource, .key = key};
  return {.file = path, .line = node.key_line > 0 ? node.key_line : node.line, .key = key};
}

struct FoundElement {
  std::string key;
  const YamlNode* node;
};

/// The first text `element` below `node`, in a list or under a key that `names_it` accepts.
std::optional<FoundElement> find_element(const YamlNode& node, const std::string& key,
                                         const std::string& element,
                                         const std::function<bool(const std::string&)>& names_it) {
  for (std::size_t i = 0; i < node.items.size(); ++i) {
    const bool is_map = node.kind == YamlNode::Kind::kMap;
    const YamlNode& child = node.items[i];
    const std::string below = is_map ? key + "." + node.keys[i] : key;
    const bool is_name = child.kind == YamlNode::Kind::kText && child.text == element;
    if (is_name && (!is_map || names_it(node.keys[i]))) return FoundElement{below, &child};
    if (auto found = find_element(child, below, element, names_it)) return found;
  }
  return std::nullopt;
}

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
  return unless_refused(read_text(text, source, problems), problems);
}

ScenarioBase::ScenarioBase(const std::string& path_or_name)
    : path_(find_scenario(path_or_name)), tree_(parse_yaml(read_text_file(path_), path_)) {}

Scenario ScenarioBase::load(const std::vector<std::string>& overrides) const {
  Problems problems(path_);
  return unless_refused(
      read_tree(tree_, {.file = path_, .folder = folder_of(path_), .overrides = overrides},
                problems),
      problems);
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
  const YamlNode tree = overridden_tree(path, overrides);
  const YamlNode* nearest = &tree;
  for (std::size_t begin = 0; begin < key.size();) {
    const std::size_t end = std::min(key.find('.', begin), key.size());
    const YamlNode* next = nearest->find(key.substr(begin, end - begin));
    if (next == nullptr) break;
    nearest = next;
    begin = end + 1;
  }
  return place_of(path, key, *nearest);
}

std::optional<InputError::Where> place_of_element(const std::string& path_or_name,
                                                  const std::vector<std::string>& overrides,
                                                  const std::string& kind,
                                                  const std::string& element) {
  const std::string path = find_scenario(path_or_name);
  const YamlNode tree = overridden_tree(path, overrides);
  const YamlNode* plant = tree.find("plant");
  if (plant == nullptr) return std::nullopt;
  const auto names_it = [&](const std::string& key) {
    return key == kind || (kind == "joint" && key == "wheel") ||
           (kind == "site" && (key == "front_axle" || key == "rear_axle"));
  };
  const auto found = find_element(*plant, "plant", element, names_it);
  if (!found) return std::nullopt;
  return place_of(path, found->key, *found->node);
}

}  // namespace qsmpc::harness
