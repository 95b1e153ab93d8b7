// Experiments that the thesis does not show: the systems of its appendix, and every scenario on
// vehicles that differ from the planner's model.

#include <algorithm>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "harness/reproduction/drive_figures.hpp"
#include "harness/reproduction/drive_rows.hpp"
#include "harness/reproduction/experiments.hpp"
#include "harness/scenario/plant_choice.hpp"

namespace qsmpc::harness {
namespace {

constexpr double kPromisedShare = 0.9;
constexpr const char* kNothingPublished = "The thesis lists the constants and shows no result.";

struct PlantDrive {
  const char* name;
  Variant variant;
};

/// The thesis's scenarios as its experiments run them.
const std::vector<PlantDrive>& drives() {
  static const std::vector<PlantDrive> all{
      {"corridor, closed loop", {.scenario = "dubins_turn"}},
      {"corridor, open loop",
       {.scenario = "dubins_turn", .overrides = {"controller.policy=open_loop"}}},
      {"corridor, closed loop, noise unseen",
       {.scenario = "dubins_turn", .overrides = {"controller.propagate_noise=false"}}},
      {"corridor, open loop, noise unseen",
       {.scenario = "dubins_turn",
        .overrides = {"controller.policy=open_loop", "controller.propagate_noise=false"}}},
      {"obstacles, L-BFGS", {.scenario = "dubins_trap"}},
      {"obstacles, SLSQP",
       {.scenario = "dubins_trap",
        .overrides = {"controller.solver=slsqp", "controller.horizon=15"}}},
      {"prediction, driven", {.scenario = "dubins_prediction"}},
      {"bicycle", {.scenario = "bicycle_square"}},
      {"bicycle, full noise",
       {.scenario = "bicycle_square", .overrides = {"controller.propagate_noise=true"}}},
      {"double integrator", {.scenario = "double_integrator"}},
      {"pendulum, swing-up", {.scenario = "cart_pole"}},
      {"pendulum, balance", {.scenario = "cart_pole_balance"}}};
  return all;
}

/// Adds rows and a figure of the drives of a scenario without published numbers.
void add_drive(Laboratory& laboratory, const std::string& name, const std::string& scenario,
               ExperimentResult& result) {
  const PublishedDrive column{.name = name, .variant = {.scenario = scenario}};
  const Sample& sample = laboratory.sample(column.variant);
  add_drive_rows(column, sample, result);
  const std::vector<NamedSample> drives{{name, &sample}};
  std::vector<Panel> panels;
  for (const Chart& chart : state_charts(drives)) panels.emplace_back(chart);
  for (const Chart& chart : input_charts(drives)) panels.emplace_back(chart);
  panels.emplace_back(risk_chart("Probability of the unsafe set", sample));
  result.figures.push_back(
      {.file = scenario + ".svg",
       .title = fmt::format("States, input and probability of the unsafe set: {}", name),
       .caption = "The first drive.",
       .panels = panels});
}

void add_share(const std::string& name, const std::string& plant, const Sample& sample,
               ExperimentResult& result) {
  const auto total = sample.episodes.size();
  const int unsafe = static_cast<int>(std::ranges::count_if(
      sample.episodes, [](const EpisodeDigest& episode) { return episode.unsafe; }));
  result.rows.push_back(
      {.quantity = fmt::format("{}, {}: drives that arrive and are never unsafe", name, plant),
       .here = safe_arrivals(sample) / static_cast<double>(total),
       .note = fmt::format("{}; {} unsafe", share_text(safe_arrivals(sample), total), unsafe),
       .place = TablePlace{.table = "Share of drives that arrive and are never unsafe",
                           .row = name,
                           .column = plant}});
}

}  // namespace

ExperimentResult double_integrator_at_rest(Laboratory& laboratory) {
  ExperimentResult result;
  add_drive(laboratory, "double integrator", "double_integrator", result);
  result.remarks = {kNothingPublished};
  return result;
}

ExperimentResult cart_pole_upright(Laboratory& laboratory) {
  ExperimentResult result;
  add_drive(laboratory, "swing-up", "cart_pole", result);
  add_drive(laboratory, "balance", "cart_pole_balance", result);
  result.remarks = {kNothingPublished,
                    "The bounds of Table B-5 leave room for a swing-up, those of Appendix D for "
                    "keeping the pole upright; both are done. The weight of the force is not the "
                    "published one; see the scenario cart_pole."};
  return result;
}

ExperimentResult scenarios_on_plants(Laboratory& laboratory) {
  ExperimentResult result;
  result.remarks = {
      "The thesis drives only its own models. Here each drive is made on its model and, with the "
      "same constants, on MuJoCo vehicles unknown to the planner: joints with the same equations, "
      "and cars on wheels whose steering and drive lag."};
  for (const PlantDrive& drive : drives()) {
    const Sample& analytic = laboratory.sample(drive.variant, laboratory.arrival_seeds());
    add_share(drive.name, "model", analytic, result);
    const double share = safe_arrivals(analytic) / static_cast<double>(analytic.episodes.size());
    result.claims.push_back(
        {.statement = fmt::format("{}: at least 90 % arrive and are never unsafe", drive.name),
         .holds = share >= kPromisedShare,
         .evidence = share_text(safe_arrivals(analytic), analytic.episodes.size())});
    for (const ShippedPlant& plant : shipped_plants()) {
      if (plant.system != analytic.scenario.model.system) continue;
      Variant variant = drive.variant;
      variant.plant = plant.name;
      add_share(drive.name, plant.name, laboratory.sample(variant), result);
    }
  }
  return result;
}

}  // namespace qsmpc::harness
