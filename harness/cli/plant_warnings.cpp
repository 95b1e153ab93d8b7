#include "harness/cli/plant_warnings.hpp"

#include <cstddef>
#include <iostream>
#include <set>

#include <fmt/format.h>

#include "harness/doctor/diagnosis.hpp"
#include "harness/errors.hpp"
#include "harness/scenario/own_model_reader.hpp"
#include "harness/scenario/plant_choice.hpp"
#include "harness/scenario/plant_mapping_reader.hpp"
#include "harness/text/printable.hpp"

namespace qsmpc::harness {
namespace {

constexpr std::size_t kMostPlants = 16;  // a quarter of a second each

/// Equal for scenarios whose plants respond alike.
std::string plant_identity(const Scenario& scenario) {
  std::string text = fmt::format("{} {} {} {}", scenario.plant.mjcf, scenario.time_step,
                                 scenario.plant.time_step.value_or(0.0), scenario.model.system);
  for (const auto& [name, value] : scenario.model.parameters) {
    text += fmt::format(" {}={}", name, value);
  }
  if (scenario.model.own) text += own_model_text(scenario.model);
  if (scenario.plant.mapping) text += plant_mapping_text(*scenario.plant.mapping);
  return text;
}

}  // namespace

void tell_plant_warnings(const Scenario& scenario, const std::string& whose) {
  const std::string prefix = whose.empty() ? "" : printable(whose) + ": ";
  for (const std::string& warning : plant_warnings(scenario)) {
    std::cerr << "qsmpc: warning: " << prefix << warning << '\n';
  }
}

void tell_plant_warnings(const Scenario& scenario, const std::vector<std::string>& plants) {
  for (const std::string& plant : plants) {
    try {
      tell_plant_warnings(with_plant(scenario, plant), plant);
    } catch (const InputError&) {
      // The comparison itself reports the error.
    }
  }
}

void tell_plant_warnings(const Campaign& campaign) {
  std::set<std::string> told;
  for (const CampaignVariant& variant : campaign.variants) {
    if (variant.resolved.plant.kind == "analytic" || told.size() == kMostPlants) continue;
    if (!told.insert(plant_identity(variant.resolved)).second) continue;
    try {
      tell_plant_warnings(variant.resolved, variant.name);
    } catch (const InputError&) {
      // Loading the campaign created this plant; if it fails now, the episodes report it as a
      // fault.
    }
  }
}

}  // namespace qsmpc::harness
