// The scenario of one variant: finds it, loads it with its settings, gives it its plant, and
// reports problems in terms of the campaign's file.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <unordered_set>

#include "harness/campaign/plan/campaign_reader.hpp"
#include "harness/campaign/plan/campaign_refusals.hpp"
#include "harness/scenario/scenario.hpp"
#include "harness/scenario/scenario_file.hpp"

namespace qsmpc::harness {

/// The path of a scenario named in the campaign `file`: a path relative to that file's folder, or
/// the name of a shipped one. Nothing, and a refusal, if there is none.
[[nodiscard]] std::optional<std::string> find_beside(const std::string& file,
                                                     const CampaignChoice& scenario,
                                                     CampaignRefusals& refusals);

/// Loads the scenarios of variants, reading each file once.
class VariantScenarios {
 public:
  explicit VariantScenarios(CampaignRefusals& refusals) : refusals_(&refusals) {}

  /// The scenario in `path` with `settings`, made such that an episode depends only on it and its
  /// seed: seed 0, and unless a setting says otherwise one thread and no deadline (which would make
  /// plans depend on the machine). Nothing, and refusals, if it is invalid: at the setting that
  /// makes it invalid, or in the scenario's own file.
  [[nodiscard]] std::optional<Scenario> load(const std::string& path, const SettingGroup& settings);

 private:
  CampaignRefusals* refusals_;
  std::map<std::string, ScenarioBase> files_;
};

/// Gives plants to scenarios; each distinct plant is constructed once as a check.
class PlantChecks {
 public:
  PlantChecks(const CampaignDraft& draft, CampaignRefusals& refusals)
      : draft_(&draft), refusals_(&refusals) {}

  /// `resolved` with `plant`, which is first looked up as a path relative to the campaign's folder.
  /// Nothing, and a refusal, if the plant cannot be constructed.
  [[nodiscard]] std::optional<Scenario> choose(const Scenario& resolved,
                                               const CampaignChoice& plant,
                                               const CampaignChoice& scenario,
                                               const SettingGroup& settings);

 private:
  const CampaignDraft* draft_;
  CampaignRefusals* refusals_;
  std::unordered_set<std::string> drawn_;  // vehicles that load
  std::unordered_set<std::string> made_;
  std::unordered_set<std::string> broken_;
};

}  // namespace qsmpc::harness
