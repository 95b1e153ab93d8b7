#include "harness/campaign/plan/campaign_file.hpp"

#include <algorithm>

#include "harness/campaign/plan/campaign_expansion.hpp"
#include "harness/campaign/plan/campaign_reader.hpp"
#include "harness/files/text_file.hpp"
#include "harness/scenario/shipped_files.hpp"
#include "harness/scenario/yaml_section.hpp"
#include "harness/scenario/yaml_tree.hpp"

namespace qsmpc::harness {
namespace {

Campaign read_file(const std::string& path, Problems& problems) {
  const YamlNode tree = parse_yaml(read_text_file(path), path);
  return expand_campaign(read_campaign(tree, path, problems), problems);
}

}  // namespace

std::string find_campaign(const std::string& path_or_name) {
  return find_file_or_shipped(path_or_name, ShippedKind::kCampaign);
}

Campaign load_campaign(const std::string& path_or_name) {
  const std::string path = find_campaign(path_or_name);
  Problems problems(path);
  Campaign campaign = read_file(path, problems);
  if (!problems.empty()) throw InputError(problems.sorted().front());
  return campaign;
}

std::vector<InputError::Where> validate_campaign_file(const std::string& path_or_name) {
  try {
    const std::string path = find_campaign(path_or_name);
    Problems problems(path);
    (void)read_file(path, problems);
    return problems.sorted();
  } catch (const InputError& error) {
    return {error.where()};
  }
}

bool is_campaign_file(const std::string& path_or_name) {
  if (!is_file(path_or_name)) {
    return find_shipped_campaign(path_or_name) && !find_shipped_scenario(path_or_name);
  }
  try {
    const YamlNode tree = parse_yaml(read_text_file(path_or_name), path_or_name);
    const auto has = [&](const char* key) { return tree.find(key) != nullptr; };
    return !has("model") && !has("controllers") &&
           std::ranges::any_of(std::initializer_list<const char*>{"scenario", "scenarios",
                                                                  "variants", "grid", "seeds"},
                               has);
  } catch (const InputError&) {
    return false;
  }
}

}  // namespace qsmpc::harness
