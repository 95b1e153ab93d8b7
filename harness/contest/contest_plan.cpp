#include "harness/contest/contest_plan.hpp"

#include <algorithm>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include <Eigen/Core>
#include <fmt/format.h>

#include "harness/campaign/plan/campaign_expansion.hpp"
#include "harness/campaign/plan/campaign_refusals.hpp"
#include "harness/campaign/plan/variant_names.hpp"
#include "harness/campaign/plan/variant_scenario.hpp"
#include "harness/scenario/scenario_file.hpp"
#include "harness/scenario/yaml_text.hpp"

namespace qsmpc::harness {
namespace {

constexpr const char* kCovarianceKey = "disturbance.covariance";

/// Expands a contest one scenario at a time, since the noise factor scales the scenario's
/// covariance.
class ContestExpansion {
 public:
  ContestExpansion(const Contest& contest, const std::vector<Contender>& contenders,
                   bool with_candidates, Problems& problems)
      : contest_(contest),
        contenders_(contenders),
        with_candidates_(with_candidates),
        problems_(problems),
        refusals_(contest.file, problems),
        scenarios_(refusals_) {}

  std::vector<CampaignVariant> expand() {
    const std::size_t before = problems_.size();
    for (const CampaignChoice& scenario : contest_.scenarios) {
      const auto path = find_beside(contest_.file, scenario, refusals_);
      if (!path) continue;
      paths_.push_back(*path);
      add_scenario(scenario, *path);
    }
    if (problems_.size() > before) return {};
    for (CampaignVariant& variant : variants_) variant.name.clear();
    name_variants(draft_of(contest_.scenarios, groups_), paths_, variants_, refusals_);
    return std::move(variants_);
  }

 private:
  void add_scenario(const CampaignChoice& scenario, const std::string& path);
  [[nodiscard]] std::optional<CampaignSetting> noise_of(const CampaignChoice& scenario,
                                                        const Eigen::MatrixXd& covariance,
                                                        std::size_t level);
  [[nodiscard]] SettingGroup group_of(const Contender& contender, std::size_t level) const;
  [[nodiscard]] CampaignDraft draft_of(const std::vector<CampaignChoice>& scenarios,
                                       std::vector<SettingGroup> groups) const;

  const Contest& contest_;
  const std::vector<Contender>& contenders_;
  bool with_candidates_;
  Problems& problems_;
  CampaignRefusals refusals_;
  VariantScenarios scenarios_;
  std::vector<std::string> paths_;    // scenario files
  std::vector<SettingGroup> groups_;  // of the current scenario
  std::vector<CampaignVariant> variants_;
};

/// All settings of a contender except the noise.
SettingGroup ContestExpansion::group_of(const Contender& contender, std::size_t level) const {
  const ContestController& controller = contest_.controllers[contender.controller];
  const ContestCandidate& candidate = controller.candidates[contender.candidate];
  SettingGroup group{
      .name = controller.name, .settings = contest_.common, .place = controller.place};
  const auto add = [&](const std::vector<CampaignSetting>& settings) {
    group.settings.insert(group.settings.end(), settings.begin(), settings.end());
  };
  add(controller.settings);
  add(candidate.settings);
  if (with_candidates_ && !candidate.label.empty()) group.name += ", " + candidate.label;
  if (contest_.noise.size() > 1 || contest_.noise[level] != 1.0) {
    group.name += fmt::format(", noise={:g}", contest_.noise[level]);
  }
  return group;
}

CampaignDraft ContestExpansion::draft_of(const std::vector<CampaignChoice>& scenarios,
                                         std::vector<SettingGroup> groups) const {
  return {.file = contest_.file,
          .name = contest_.name,
          .scenarios = scenarios,
          .variants = std::move(groups),
          .grid = {},
          .plants = contest_.plants,
          .seeds = contest_.seeds};
}

/// Returns nothing where the noise is the scenario's own, or where it cannot be scaled; the latter
/// is refused.
std::optional<CampaignSetting> ContestExpansion::noise_of(const CampaignChoice& scenario,
                                                          const Eigen::MatrixXd& covariance,
                                                          std::size_t level) {
  const double factor = contest_.noise[level];
  if (factor == 1.0) return std::nullopt;
  const std::string path = fmt::format("noise.{}", level);
  if (covariance.isZero(0.0)) {
    refusals_.add(
        CampaignPlace{.line = contest_.noise_line, .path = path},
        fmt::format("a factor of {:g} for {}, which has no disturbance", factor, scenario.text),
        "noise: [1], or a scenario with a disturbance.covariance");
    return std::nullopt;
  }
  const std::string value = yaml_square(factor * covariance);
  return CampaignSetting{.key = kCovarianceKey,
                         .value = parse_yaml(value, contest_.file),
                         .text = std::string(kCovarianceKey) + "=" + value,
                         .owner = path,
                         .line = contest_.noise_line};
}

void ContestExpansion::add_scenario(const CampaignChoice& scenario, const std::string& path) {
  const std::size_t before = problems_.size();
  const SettingGroup common{.name = "", .settings = contest_.common, .place = scenario.place};
  const std::optional<Scenario> base = scenarios_.load(path, common);
  if (!base) return;
  std::vector<std::optional<CampaignSetting>> noise;
  for (std::size_t level = 0; level < contest_.noise.size(); ++level) {
    noise.push_back(noise_of(scenario, base->disturbance.covariance, level));
  }
  if (problems_.size() > before) return;
  groups_.clear();
  for (const Contender& contender : contenders_) {
    for (std::size_t level = 0; level < noise.size(); ++level) {
      groups_.push_back(group_of(contender, level));
      if (noise[level]) groups_.back().settings.push_back(*noise[level]);
    }
  }
  Campaign part = expand_campaign(draft_of({scenario}, groups_), problems_);
  std::ranges::move(part.variants, std::back_inserter(variants_));
}

}  // namespace

std::vector<Contender> searched_contenders(const Contest& contest) {
  std::vector<Contender> all;
  if (!contest.tuning) return all;
  for (std::size_t n = 0; n < contest.controllers.size(); ++n) {
    const std::size_t candidates = contest.controllers[n].candidates.size();
    for (std::size_t c = 0; candidates > 1 && c < candidates; ++c) {
      all.push_back({.controller = n, .candidate = c});
    }
  }
  return all;
}

std::vector<Contender> chosen_contenders(const ContestChoice& choice) {
  std::vector<Contender> all;
  for (std::size_t n = 0; n < choice.size(); ++n) {
    all.push_back({.controller = n, .candidate = choice[n]});
  }
  return all;
}

std::size_t variant_of(const Contest& contest, std::size_t contenders, std::size_t contender,
                       const ContestCell& cell) {
  const std::size_t levels = contest.noise.size();
  return ((cell.scenario * contenders + contender) * levels + cell.noise) * contest.plants.size() +
         cell.plant;
}

Campaign contest_campaign(const Contest& contest, const std::vector<Contender>& contenders,
                          const SeedSet& seeds, bool with_candidates, Problems& problems) {
  return {.name = contest.name,
          .variants = ContestExpansion(contest, contenders, with_candidates, problems).expand(),
          .seeds = seeds};
}

SeedSet first_seeds(const SeedSet& seeds, std::int64_t count) {
  SeedSet first = seeds;
  if (!seeds.listed.empty()) {
    first.listed.resize(std::min(seeds.listed.size(), static_cast<std::size_t>(count)));
  } else {
    first.count = std::min(seeds.count, count);
  }
  return first;
}

}  // namespace qsmpc::harness
