#include "harness/campaign/plan/variant_names.hpp"

#include <cstddef>
#include <filesystem>
#include <map>
#include <unordered_set>

namespace qsmpc::harness {
namespace {

constexpr const char* kUnique = "names that differ";

/// The name of each scenario i, whose first variant is variants[i·per_scenario].
std::vector<std::string> scenario_labels(const std::vector<CampaignVariant>& variants,
                                         const std::vector<std::string>& paths) {
  const std::size_t per_scenario = variants.size() / paths.size();
  std::vector<std::string> labels;
  std::map<std::string, int> count;
  for (std::size_t i = 0; i < paths.size(); ++i) {
    labels.push_back(variants[i * per_scenario].resolved.name);
    ++count[labels.back()];
  }
  for (std::size_t i = 0; i < paths.size(); ++i) {
    if (count[labels[i]] > 1) labels[i] = std::filesystem::path(paths[i]).stem().string();
  }
  return labels;
}

void refuse_equal_scenarios(const CampaignDraft& draft, const std::vector<std::string>& labels,
                            CampaignRefusals& refusals) {
  std::unordered_set<std::string> seen;
  for (std::size_t i = 0; i < labels.size(); ++i) {
    if (seen.insert(labels[i]).second) continue;
    refusals.add(draft.scenarios[i].place, "a second scenario called " + labels[i], kUnique);
  }
}

void refuse_equal_settings(const CampaignDraft& draft, CampaignRefusals& refusals) {
  std::unordered_set<std::string> seen;
  for (const SettingGroup& variant : draft.variants) {
    if (seen.insert(variant.name).second) continue;
    refusals.add(variant.place, "a second variant called " + variant.name, kUnique);
  }
}

}  // namespace

void name_variants(const CampaignDraft& draft, const std::vector<std::string>& scenario_paths,
                   std::vector<CampaignVariant>& variants, CampaignRefusals& refusals) {
  const std::vector<std::string> labels = scenario_labels(variants, scenario_paths);
  refuse_equal_scenarios(draft, labels, refusals);
  refuse_equal_settings(draft, refusals);
  const std::size_t per_scenario = variants.size() / scenario_paths.size();
  const bool many_plants = draft.plants.size() > 1;
  const bool many_settings = per_scenario > draft.plants.size();
  const bool many_scenarios = scenario_paths.size() > 1;
  std::unordered_set<std::string> seen;
  for (std::size_t i = 0; i < variants.size(); ++i) {
    CampaignVariant& variant = variants[i];
    const std::string& scenario = labels[i / per_scenario];
    const auto append = [&](const std::string& part) {
      variant.name += (variant.name.empty() ? "" : " / ") + part;
    };
    if (many_scenarios) append(scenario);
    if (many_settings) append(variant.settings);
    if (many_plants) append(variant.plant);
    if (variant.name.empty()) {
      variant.name = variant.settings.empty() ? scenario : variant.settings;
    }
    // Parts that contain the separator can still give two variants the same name.
    if (seen.insert(variant.name).second || !refusals.empty()) continue;
    refusals.add(CampaignPlace{}, "two variants called " + variant.name, kUnique);
  }
}

}  // namespace qsmpc::harness
