#include "harness/campaign/plan/variant_scenario.hpp"

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <limits>
#include <string_view>
#include <utility>
#include <vector>

#include "harness/errors.hpp"
#include "harness/files/text_file.hpp"
#include "harness/plant/plant_check.hpp"
#include "harness/scenario/known_names.hpp"
#include "harness/scenario/overrides.hpp"
#include "harness/scenario/plant_choice.hpp"
#include "harness/scenario/scenario_file.hpp"
#include "harness/scenario/shipped_files.hpp"

namespace qsmpc::harness {
namespace {

namespace fs = std::filesystem;
using Settings = std::vector<CampaignSetting>;

std::optional<std::string> file_beside(const std::string& file, const std::string& name) {
  const fs::path path = fs::path(file).parent_path() / name;  // `name` itself if it is absolute
  return is_file(path) ? std::optional(path.string()) : std::nullopt;
}

/// Whether a setting sets `key`, directly or in an enclosing mapping.
bool sets(const Settings& settings, const std::string& key) {
  for (const CampaignSetting& setting : settings) {
    if (!is_key_within(key, setting.key)) continue;
    const YamlNode* node = &setting.value;
    std::size_t begin = setting.key.size() + 1;
    while (node != nullptr && begin < key.size()) {
      const std::size_t end = std::min(key.find('.', begin), key.size());
      node = node->find(key.substr(begin, end - begin));
      begin = end + 1;
    }
    if (node != nullptr) return true;
  }
  return false;
}

/// The setting to blame for a problem with `key`: the last one that contains it, else the last one
/// within it.
const CampaignSetting* setting_about(const Settings& settings, const std::string& key) {
  const auto last_that = [&](const auto& is_meant) -> const CampaignSetting* {
    const auto at = std::find_if(settings.rbegin(), settings.rend(), is_meant);
    return at == settings.rend() ? nullptr : &*at;
  };
  const CampaignSetting* holding =
      last_that([&](const CampaignSetting& setting) { return is_key_within(key, setting.key); });
  return holding != nullptr ? holding : last_that([&](const CampaignSetting& setting) {
    return is_key_within(setting.key, key);
  });
}

std::vector<std::string> texts_of(const Settings& settings, std::size_t count) {
  std::vector<std::string> texts;
  texts.reserve(count);
  for (std::size_t i = 0; i < count; ++i) texts.push_back(settings[i].text);
  return texts;
}

/// A setting that makes the scenario, valid with those before it, invalid; found by bisection.
/// nullptr if the scenario is invalid without settings.
const CampaignSetting* breaking_setting(const std::string& path, const Settings& settings) {
  const auto is_valid_with = [&](std::size_t count) {
    return validate_scenario_file(path, texts_of(settings, count)).empty();
  };
  if (settings.empty() || !is_valid_with(0)) return nullptr;
  std::size_t valid = 0;
  std::size_t broken = settings.size();
  while (broken - valid > 1) {
    const std::size_t middle = valid + (broken - valid) / 2;
    (is_valid_with(middle) ? valid : broken) = middle;
  }
  return &settings[valid];
}

CampaignPlace place_of(const CampaignSetting& setting, const std::string& key) {
  return {.line = setting.line, .path = path_of(setting, key)};
}

/// `first`: the problem that was thrown.
void refuse_scenario(const std::string& path, const Settings& settings,
                     const InputError::Where& first, CampaignRefusals& refusals) {
  std::optional<const CampaignSetting*> breaking;  // determined on first use
  std::vector<InputError::Where> problems =
      validate_scenario_file(path, texts_of(settings, settings.size()));
  if (problems.empty()) problems.push_back(first);  // the file has changed since
  for (InputError::Where& where : problems) {
    if (where.file == kOverrideSource && !settings.empty()) {
      const CampaignSetting* setting = setting_about(settings, where.key);
      if (setting == nullptr) setting = &settings.back();
      refusals.add(place_of(*setting, where.key), where.found, where.expected);
      continue;
    }
    if (!breaking) breaking = breaking_setting(path, settings);
    if (where.file == path && *breaking != nullptr) {
      refusals.add(place_of(**breaking, (*breaking)->key),
                   "with this setting, " + where.key + ": " + where.found, where.expected);
    } else {
      refusals.add(std::move(where));
    }
  }
}

/// A text that is equal for scenarios with the same plant.
std::string plant_text(Scenario scenario) {
  // A disturbance added to the state does not change the plant.
  Scenario::Disturbance& disturbance = scenario.disturbance;
  if (disturbance.kind == "state") disturbance.covariance.setZero();
  disturbance.sensor.setZero();
  const std::string yaml = to_yaml(scenario);
  std::string text;
  bool is_of_plant = false;  // whether the current top-level key belongs to the plant
  for (std::size_t begin = 0; begin < yaml.size();) {
    const std::size_t end = std::min(yaml.find('\n', begin), yaml.size());
    const std::string_view line = std::string_view(yaml).substr(begin, end - begin);
    if (!line.starts_with(' ')) {
      const std::string_view key = line.substr(0, line.find(':'));
      is_of_plant = key == "model" || key == "time_step" || key == "plant" || key == "disturbance";
    }
    if (is_of_plant) text.append(line).push_back('\n');
    begin = end + 1;
  }
  return text;
}

std::string in_words(const InputError::Where& where) {
  std::string words;
  for (const std::string& part : {where.file, where.key}) {
    if (!part.empty()) words += part + ": ";
  }
  return words + where.found;
}

}  // namespace

std::optional<std::string> find_beside(const std::string& file, const CampaignChoice& scenario,
                                       CampaignRefusals& refusals) {
  if (auto path = file_beside(file, scenario.text)) return path;
  if (auto path = find_shipped_scenario(scenario.text)) return path;
  refusals.add(scenario.place, scenario.text,
               "a scenario file next to the campaign file, or " +
                   expected_names(scenario.text, shipped_scenario_names()));
  return std::nullopt;
}

std::optional<Scenario> VariantScenarios::load(const std::string& path,
                                               const SettingGroup& settings) {
  try {
    const ScenarioBase& base = files_.try_emplace(path, path).first->second;
    Scenario scenario = base.load(texts_of(settings.settings, settings.settings.size()));
    scenario.seed = 0;
    if (!sets(settings.settings, "controller.threads")) scenario.controller.threads = 1;
    if (!sets(settings.settings, "controller.deadline")) {
      scenario.controller.deadline = std::numeric_limits<double>::infinity();
    }
    return scenario;
  } catch (const InputError& error) {
    refuse_scenario(path, settings.settings, error.where(), *refusals_);
    return std::nullopt;
  }
}

std::optional<Scenario> PlantChecks::choose(const Scenario& resolved, const CampaignChoice& plant,
                                            const CampaignChoice& scenario,
                                            const SettingGroup& settings) {
  try {
    Scenario driven = resolved;
    if (!plant.text.empty()) {
      const bool names_file = fs::path(plant.text).extension() == ".xml";
      const auto beside = names_file ? file_beside(draft_->file, plant.text) : std::nullopt;
      driven = with_plant(std::move(driven), beside ? fs::absolute(*beside).string() : plant.text);
    }
    const std::string text = plant_text(driven);
    if (broken_.contains(text)) return std::nullopt;
    if (!made_.contains(text)) {
      broken_.insert(text);
      const std::string vehicle = driven.plant.kind + ' ' + driven.plant.mjcf;
      if (!drawn_.contains(vehicle)) try_drawn_vehicle(driven);
      drawn_.insert(vehicle);
      try_driven_plant(driven);
      broken_.erase(text);
      made_.insert(text);
    }
    return driven;
  } catch (const InputError& error) {
    const InputError::Where& where = error.where();
    const bool is_choice = where.key == "--plant";
    const std::string key = where.file.empty() ? where.key : "plant";
    const CampaignSetting* setting = is_choice ? nullptr : setting_about(settings.settings, key);
    const bool named = !plant.text.empty();
    const std::string found = is_choice ? plant.text : in_words(where);
    const std::string whose = draft_->scenarios.size() > 1 ? ", for " + scenario.text : "";
    const CampaignPlace place = setting != nullptr && (!named || where.file.empty())
                                    ? place_of(*setting, setting->key)
                                    : (named ? plant.place : scenario.place);
    refusals_->add(place, found + (named ? whose : ""), where.expected);
    return std::nullopt;
  }
}

}  // namespace qsmpc::harness
