#include <memory>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "controller/control/controller.hpp"
#include "controller/estimation/estimator.hpp"
#include "controller/laws/law_propagator.hpp"
#include "controller/measure/quantisation/gaussian_quantiser.hpp"
#include "controller/planning/solvers/ocp_solver.hpp"
#include "controller/prediction/propagator.hpp"
#include "harness/cli/commands.hpp"
#include "harness/cli/exit_codes.hpp"
#include "harness/cli/output.hpp"
#include "harness/plant/plant_registry.hpp"
#include "harness/scenario/outside_controllers.hpp"
#include "harness/scenario/plant_choice.hpp"
#include "harness/scenario/shipped_files.hpp"
#include "harness/text/json_text.hpp"
#include "models/dynamics/dynamics.hpp"

namespace qsmpc::harness {
namespace {

struct Item {
  std::string name;
  std::string summary;
};

struct Table {
  std::string title;
  std::vector<Item> items;
};

template <class Entries>
Table make_table(const std::string& title, const Entries& entries) {
  Table table{.title = title, .items = {}};
  for (const auto& entry : entries) table.items.push_back({entry.name, entry.summary});
  return table;
}

std::vector<Table> tables() {
  Table all_plants = make_table("plants", plants());
  for (const ShippedPlant& plant : shipped_plants()) {
    all_plants.items.push_back(
        {plant.name, fmt::format("for {}: {} ({})", plant.system, plant.summary, plant.mjcf)});
  }
  Table scenarios{.title = "scenarios", .items = {}};
  for (const ShippedScenario& scenario : shipped_scenarios()) {
    scenarios.items.push_back({scenario.name, scenario.description});
  }
  Table campaigns{.title = "campaigns", .items = {}};
  for (const ShippedCampaign& campaign : shipped_campaigns()) {
    campaigns.items.push_back({campaign.name, campaign.description});
  }
  Table contests{.title = "contests", .items = {}};
  for (const ShippedContest& contest : shipped_contests()) {
    contests.items.push_back({contest.name, contest.description});
  }
  Table all_controllers = make_table("controllers", controller::controllers());
  for (const OutsideControllerEntry& entry : outside_controllers()) {
    all_controllers.items.push_back({entry.name, entry.summary});
  }
  return {make_table("systems", models::systems()),
          all_plants,
          all_controllers,
          make_table("estimators", controller::estimators()),
          make_table("solvers", controller::solvers()),
          make_table("boundings", controller::input_boundings()),
          make_table("propagators", controller::propagators()),
          make_table("quantisers", controller::quantisers()),
          make_table("methods", controller::law_methods()),
          scenarios,
          campaigns,
          contests};
}

std::string as_text(const std::vector<Table>& chosen) {
  std::string text;
  for (const Table& table : chosen) {
    text += table.title + "\n";
    for (const Item& item : table.items) {
      text += fmt::format("  {:<24} {}\n", item.name, item.summary);
    }
  }
  return text;
}

std::string as_json(const std::vector<Table>& chosen) {
  nlohmann::ordered_json json;
  for (const Table& table : chosen) {
    json[table.title] = nlohmann::ordered_json::array();
    for (const Item& item : table.items) {
      json[table.title].push_back({{"name", item.name}, {"summary", item.summary}});
    }
  }
  return json_text(json);
}

int list(const std::string& kind, bool json) {
  std::vector<Table> chosen;
  for (Table& table : tables()) {
    if (kind.empty() || kind == table.title) chosen.push_back(std::move(table));
  }
  print_result(json ? as_json(chosen) : as_text(chosen));
  return kDone;
}

}  // namespace

void add_list_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand(
      "list", "Lists the available scenarios, plants, controllers and other names.");
  command->footer("Example: qsmpc list scenarios");
  const auto kind = std::make_shared<std::string>();
  const auto json = std::make_shared<bool>(false);
  command
      ->add_option(
          "kind", *kind,
          "systems, plants, controllers, estimators, solvers, boundings, propagators, quantisers, "
          "methods (of prediction), scenarios, campaigns or contests")
      ->check(CLI::IsMember({"systems", "plants", "controllers", "estimators", "solvers",
                             "boundings", "propagators", "quantisers", "methods", "scenarios",
                             "campaigns", "contests"}));
  command->add_flag("--json", *json, "print JSON");
  command->callback([kind, json, &exit_code] { exit_code = list(*kind, *json); });
}

}  // namespace qsmpc::harness
