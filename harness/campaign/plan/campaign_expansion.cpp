#include "harness/campaign/plan/campaign_expansion.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <unordered_set>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "harness/campaign/plan/campaign_refusals.hpp"
#include "harness/campaign/plan/variant_families.hpp"
#include "harness/campaign/plan/variant_names.hpp"
#include "harness/campaign/plan/variant_scenario.hpp"
#include "harness/scenario/scenario_file.hpp"

namespace qsmpc::harness {
namespace {

// Every variant holds its settings as text; a short file could request gigabytes of them.
constexpr double kMostSettingBytes = 16.0 * 1024 * 1024;
constexpr std::int64_t kCountedTo = 1'000'000'000'000'000;  // larger counts are not exact
constexpr int kMostRefused = 100;  // refused variants; more are of no use, and each takes time

std::int64_t size_of(const auto& list) { return static_cast<std::int64_t>(list.size()); }

std::int64_t times(std::int64_t a, std::int64_t b) {
  return a > kCountedTo / b ? kCountedTo : a * b;
}

std::int64_t grid_points(const CampaignDraft& draft) {
  std::int64_t points = 1;
  for (const GridAxis& axis : draft.grid) points = times(points, size_of(axis.values));
  return points;
}

CampaignPlace largest_part(const CampaignDraft& draft) {
  if (draft.grid.empty()) return draft.variants.back().place;
  return {.line = draft.grid.front().line, .path = "grid"};
}

std::size_t bytes_of(const std::vector<CampaignSetting>& settings) {
  std::size_t bytes = 0;
  for (const CampaignSetting& setting : settings) bytes += setting.text.size();
  return bytes;
}

/// Total size of the settings of all variants.
double setting_bytes(const CampaignDraft& draft) {
  const auto points = static_cast<double>(grid_points(draft));
  double bytes = 0.0;
  for (const SettingGroup& variant : draft.variants) {
    bytes += points * static_cast<double>(bytes_of(variant.settings));
  }
  for (const GridAxis& axis : draft.grid) {
    bytes += static_cast<double>(draft.variants.size()) * points *
             static_cast<double>(bytes_of(axis.values)) / static_cast<double>(axis.values.size());
  }
  return bytes * static_cast<double>(draft.scenarios.size() * draft.plants.size());
}

class Expansion {
 public:
  Expansion(const CampaignDraft& draft, Problems& problems)
      : draft_(draft),
        refusals_(draft.file, problems),
        scenarios_(refusals_),
        plants_(draft, refusals_) {}

  Campaign expand() {
    Campaign campaign{.name = draft_.name,
                      .variants = {},
                      .seeds = draft_.seeds,
                      .traces = draft_.traces,
                      .trace_sample = draft_.trace_sample,
                      .risk_against_cost = {},
                      .until = draft_.until,
                      .rare = draft_.rare};
    if (draft_.scenarios.empty() || !is_small_enough()) return campaign;
    refuse_undone();
    for (const CampaignChoice& scenario : draft_.scenarios) {
      if (const auto path = find_beside(draft_.file, scenario, refusals_)) {
        paths_.push_back(*path);
        add_scenario(scenario, *path);
      }
    }
    if (refusals_.empty()) name_variants(draft_, paths_, variants_, refusals_);
    campaign.variants = std::move(variants_);
    if (!draft_.families.empty()) {
      campaign.risk_against_cost = known_families(draft_.families, all_settings(), refusals_);
    }
    return campaign;
  }

 private:
  [[nodiscard]] bool is_small_enough();
  void refuse_undone();
  void add_scenario(const CampaignChoice& scenario, const std::string& path);
  void add_settings(const CampaignChoice& scenario, const std::string& path,
                    const SettingGroup& settings);
  void refuse_fixed_noise(const CampaignChoice& scenario, const Scenario& resolved);
  [[nodiscard]] SettingGroup with_grid_point(const SettingGroup& variant, std::int64_t point) const;
  [[nodiscard]] std::vector<std::string> all_settings() const;

  const CampaignDraft& draft_;
  CampaignRefusals refusals_;
  VariantScenarios scenarios_;
  PlantChecks plants_;
  std::vector<std::string> paths_;  // scenario files
  std::vector<CampaignVariant> variants_;
  int refused_ = 0;
};

bool Expansion::is_small_enough() {
  const std::int64_t points = grid_points(draft_);
  const std::int64_t count =
      times(times(times(size_of(draft_.scenarios), size_of(draft_.variants)), points),
            size_of(draft_.plants));
  if (count > kMostCampaignVariants) {
    refusals_.add(
        largest_part(draft_),
        fmt::format(
            "{} x {} variants x {} grid points x {} = {}{} variants",
            draft_.scenarios.size() == 1 ? "1 scenario"
                                         : fmt::format("{} scenarios", draft_.scenarios.size()),
            draft_.variants.size(), points,
            draft_.plants.size() == 1 ? "1 plant" : fmt::format("{} plants", draft_.plants.size()),
            count == kCountedTo ? "over " : "", count),
        fmt::format("at most {}", kMostCampaignVariants));
    return false;
  }
  const double bytes = setting_bytes(draft_);
  if (bytes <= kMostSettingBytes) return true;
  refusals_.add(largest_part(draft_),
                fmt::format("settings of {:.0f} bytes, over all variants", bytes),
                fmt::format("at most {:.0f} bytes", kMostSettingBytes));
  return false;
}

/// A setting that replaces an earlier one, or the mapping that contains it, would silently undo it.
void Expansion::refuse_undone() {
  for (const SettingGroup& variant : draft_.variants) {
    std::unordered_set<std::string> set;  // all keys set, and their parents
    const auto take = [&](const std::string& key, int line, const std::string& path) {
      if (set.contains(key)) {
        refusals_.add({.line = line, .path = path},
                      key + " a second time, or after a key within it", "each key once");
      }
      for (std::size_t end = key.find('.'); end != std::string::npos;
           end = key.find('.', end + 1)) {
        set.insert(key.substr(0, end));
      }
      set.insert(key);
    };
    for (const CampaignSetting& setting : variant.settings) {
      take(setting.key, setting.line, setting.owner + "." + setting.key);
    }
    for (const GridAxis& axis : draft_.grid) take(axis.key, axis.line, "grid." + axis.key);
    if (refusals_.many()) return;
  }
}

SettingGroup Expansion::with_grid_point(const SettingGroup& variant, std::int64_t point) const {
  SettingGroup settings = variant;
  std::int64_t stride = grid_points(draft_);
  for (const GridAxis& axis : draft_.grid) {
    stride /= size_of(axis.values);
    const auto index = static_cast<std::size_t>(point / stride % size_of(axis.values));
    settings.settings.push_back(axis.values[index]);
    settings.name += (settings.name.empty() ? "" : ", ") + axis.values[index].text;
  }
  return settings;
}

/// The label of the settings of each variant and grid point.
std::vector<std::string> Expansion::all_settings() const {
  const std::int64_t points = grid_points(draft_);
  std::vector<std::string> names;
  for (const SettingGroup& variant : draft_.variants) {
    for (std::int64_t point = 0; point < points; ++point) {
      names.push_back(with_grid_point(variant, point).name);
    }
  }
  return names;
}

void Expansion::add_scenario(const CampaignChoice& scenario, const std::string& path) {
  const std::int64_t points = grid_points(draft_);
  const std::size_t before = variants_.size();
  for (const SettingGroup& variant : draft_.variants) {
    for (std::int64_t point = 0; point < points; ++point) {
      if (refused_ >= kMostRefused || refusals_.many()) return;
      add_settings(scenario, path, with_grid_point(variant, point));
    }
  }
  // Problems with the plants are reported even while no settings are valid.
  if (variants_.size() == before && validate_scenario_file(path).empty()) {
    add_settings(scenario, path, {});
  }
}

void Expansion::add_settings(const CampaignChoice& scenario, const std::string& path,
                             const SettingGroup& settings) {
  const std::optional<Scenario> resolved = scenarios_.load(path, settings);
  if (!resolved) {
    ++refused_;
    return;
  }
  std::vector<std::string> overrides;
  for (const CampaignSetting& setting : settings.settings) overrides.push_back(setting.text);
  refuse_fixed_noise(scenario, *resolved);
  for (const CampaignChoice& plant : draft_.plants) {
    std::optional<Scenario> driven = plants_.choose(*resolved, plant, scenario, settings);
    if (!driven) {
      ++refused_;
      continue;
    }
    variants_.push_back({.name = "",
                         .scenario = scenario.text,
                         .settings = settings.name,
                         .overrides = overrides,
                         .plant = plant.text,
                         .resolved = std::move(*driven)});
  }
}

/// Refuses what would make a drive depend on more than its seed.
void Expansion::refuse_fixed_noise(const CampaignChoice& scenario, const Scenario& resolved) {
  if (!resolved.disturbance.seeds.empty()) {
    refusals_.add(scenario.place, "a scenario with disturbance.seeds",
                  "one whose noise is drawn from the campaign's seeds");
  }
  if (draft_.rare && std::isfinite(resolved.controller.deadline)) {
    refusals_.add(scenario.place, "controller.deadline together with rare outcomes",
                  "no deadline, because repeated drives must be identical");
  }
}

}  // namespace

Campaign expand_campaign(const CampaignDraft& draft, Problems& problems) {
  return Expansion(draft, problems).expand();
}

}  // namespace qsmpc::harness
