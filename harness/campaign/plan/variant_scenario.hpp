// The scenario of one variant: found, loaded with its settings, given its plant; and what is wrong
// with it said in terms of the campaign's file.
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

/// The path of a scenario that the campaign in `file` names: a path relative to that file's folder,
/// or a shipped one's name. Nothing, and a refusal, if there is none.
[[nodiscard]] std::optional<std::string> find_beside(const std::string& file,
                                                     const CampaignChoice& scenario,
                                                     CampaignRefusals& refusals);

/// Scenarios as variants have them, each file read once.
class VariantScenarios {
 public:
  explicit VariantScenarios(CampaignRefusals& refusals) : refusals_(&refusals) {}

  /// The scenario in `path` with `settings`, so that an episode depends on nothing but it and its
  /// seed: seed 0, and unless a setting says otherwise one thread and no deadline (what a plan is
  /// after a time depends on the machine). Nothing, and refusals, if it is not valid: at the
  /// setting that makes it so, or in the scenario's own file.
  [[nodiscard]] std::optional<Scenario> load(const std::string& path, const SettingGroup& settings);

 private:
  CampaignRefusals* refusals_;
  std::map<std::string, ScenarioBase> files_;
};

/// Gives plants to scenarios, each different one tried once.
class PlantChecks {
 public:
  PlantChecks(const CampaignDraft& draft, CampaignRefusals& refusals)
      : draft_(&draft), refusals_(&refusals) {}

  /// `resolved` on `plant`, a path relative to the campaign's folder first, that can be made.
  /// Nothing, and a refusal, if it cannot.
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
