#include "harness/report/comparison_page.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include <fmt/format.h>

#include "harness/assembly/assembly.hpp"
#include "harness/figures/svg_figure.hpp"
#include "harness/report/comparison_charts.hpp"
#include "harness/report/comparison_verdict.hpp"
#include "harness/report/page_frame.hpp"
#include "harness/report/table_page.hpp"
#include "harness/scenario/certificate_scope.hpp"
#include "harness/text/html.hpp"
#include "harness/text/number_format.hpp"
#include "harness/text/unit_text.hpp"

namespace qsmpc::harness {
namespace {

/// The header of the certified values of the drives. Along the plan the policy sees the state, so
/// those certificates are always bounds.
const char* certified_head(const Comparison& comparison) {
  return why_no_bound(comparison.scenario).empty() ? "certified" : "certified: no bound";
}

std::string kicker(const Comparison& comparison) {
  const Scenario& scenario = comparison.scenario;
  const bool is_single = comparison.plants.size() == 1;
  return fmt::format(
      "<p class=\"kicker\">{} plant{} compared with the model {} · {} episodes and {} paths{} · {} "
      "· seed {}</p>\n",
      comparison.plants.size(), is_single ? "" : "s", escape_html(scenario.model.system),
      comparison.plants.front().closed_loop.episodes, comparison.paths, is_single ? "" : " of each",
      escape_html(controller_words(scenario)), scenario.seed);
}

std::string plus_minus(double value, double deviation) {
  if (!std::isfinite(deviation)) return number_html(value);
  return fmt::format("{} <span class=\"soft\">± {}</span>", number_html(value),
                     number_html(deviation));
}

/// Highlighted unless 0.
std::string failures_html(std::int64_t count) {
  return count == 0 ? "0" : fmt::format("<strong class=\"alarm\">{}</strong>", count);
}

std::string closed_loop_section(const Comparison& comparison) {
  PageTable table{.label = "Closed loop, by plant",
                  .heads = {"plant", "drives", "reached", "collision", "left bounds", "timeout",
                            "fault", "unsafe", "share unsafe, 99 % interval", "cost",
                            "least clearance", "speed (× real time)"},
                  .rows = {}};
  for (const PlantComparison& plant : comparison.plants) {
    const ClosedLoop& loop = plant.closed_loop;
    table.rows.push_back({escape_html(plant.name), fmt::format("{}", loop.episodes),
                          fmt::format("{}", loop.count(Outcome::kReached)),
                          failures_html(loop.count(Outcome::kCollision)),
                          failures_html(loop.count(Outcome::kLeftBounds)),
                          fmt::format("{}", loop.count(Outcome::kTimeout)),
                          failures_html(loop.count(Outcome::kFault)), failures_html(loop.unsafe),
                          interval_html(loop.unsafe_limits),
                          plus_minus(loop.cost, loop.cost_deviation),
                          number_html(loop.min_clearance), number_html(plant.speed)});
  }
  return section_head(
             "Closed loop",
             "Drives with the same seeds. Collision and left bounds: how the true state first "
             "became unsafe at a control instant. Unsafe: all drives that were, including those "
             "that faulted later. Mean cost with its standard error. Speed: simulated seconds per "
             "wall-clock second of one plant in one thread, without the planner.") +
         table_html(table);
}

std::string state_head(const models::Coordinate& state) {
  return escape_html(state.unit.empty() ? state.name
                                        : state.name + " (" + printed_unit(state.unit) + ")");
}

PageTable residual_table(const Comparison& comparison, const PlantComparison& plant,
                         const models::SystemDescription& system) {
  PageTable table{.label = "One period, by state: " + plant.name,
                  .heads = {"state", "root mean square", "mean", "disturbance", "lag-1 correlation",
                            "p (white noise)"},
                  .rows = {}};
  const ResidualStatistics& own = plant.one_step;
  for (Eigen::Index i = 0; i < own.rmse.size(); ++i) {
    table.rows.push_back({state_head(system.states[static_cast<std::size_t>(i)]),
                          number_html(own.rmse[i]), plus_minus(own.mean[i], own.mean_deviation[i]),
                          number_html(std::sqrt(comparison.scenario.disturbance.covariance(i, i))),
                          number_html(own.whiteness.lag1[i]),
                          number_html(own.whiteness.p_value[i])});
  }
  return table;
}

PageTable covariance_table(const PlantComparison& plant, const models::SystemDescription& system) {
  PageTable table{.label = "Covariance of the residual: " + plant.name, .heads = {""}, .rows = {}};
  const Eigen::MatrixXd& covariance = plant.one_step.covariance;
  for (Eigen::Index i = 0; i < covariance.rows(); ++i) {
    const std::string& name = system.states[static_cast<std::size_t>(i)].name;
    table.heads.push_back(escape_html(name));
    std::vector<std::string> row = {escape_html(name)};
    for (const double value : covariance.row(i)) row.push_back(number_html(value));
    table.rows.push_back(std::move(row));
  }
  return table;
}

/// A plant's residuals per period: tables, or one sentence if all of them are rounding.
std::string residuals_of(const Comparison& comparison, const PlantComparison& plant,
                         const models::SystemDescription& system) {
  if (is_the_model(plant)) {
    return fmt::format(
        "<p>It matches the model except for rounding, which is at most {} in any state (root mean "
        "square).</p>\n",
        number_html(plant.one_step.rmse.maxCoeff()));
  }
  return table_html(residual_table(comparison, plant, system)) +
         fmt::format(
             "<details class=\"more\">\n<summary>Covariance of the residual: {}</summary>\n"
             "{}</details>\n",
             escape_html(plant.name), table_html(covariance_table(plant, system)));
}

std::string figures(const ComparisonFigure& figure) {
  std::string html =
      figure.charts.size() % 3 == 0 ? "<div class=\"grid thirds\">\n" : "<div class=\"grid\">\n";
  for (const Chart& chart : figure.charts) html += panel_figure(chart);
  return html + "</div>\n";
}

std::string name_head(const PlantComparison& plant) {
  return "<h3 class=\"name\">" + escape_html(plant.name) + "</h3>\n";
}

/// Whether some plant differs from the model by more than rounding, so that charts are worthwhile.
bool has_mismatch(const Comparison& comparison) {
  return !std::ranges::all_of(comparison.plants, is_the_model);
}

std::string residual_section(const Comparison& comparison, const models::SystemDescription& system,
                             const ComparisonFigure& figure) {
  const std::string head = section_head(
      "One period: what the plant adds to model and disturbance",
      "Over all periods of all episodes. Mean with its standard error; the disturbance’s standard "
      "deviation for scale. p is small where residuals are correlated over time.");
  std::string tables;
  for (const PlantComparison& plant : comparison.plants) {
    tables += name_head(plant) + residuals_of(comparison, plant, system);
  }
  if (!has_mismatch(comparison)) return head + tables;
  // The chart is placed beside the tables if they leave room for it.
  constexpr std::size_t kMostBeside = 3;  // states
  if (system.states.size() > kMostBeside) return head + tables + figures(figure);
  std::string html =
      head + "<div class=\"grid beside\">\n<div class=\"stack residuals\">\n" + tables + "</div>\n";
  for (const Chart& chart : figure.charts) html += panel_figure(chart);
  return html + "</div>\n";
}

/// Whether the certificate in force at the stage with index `k` is exceeded.
bool is_exceeded(const PlantComparison& plant, std::size_t k) {
  const std::vector<int>& stages = plant.exceeded_stages;
  return std::ranges::find(stages, plant.horizon[k].stage) != stages.end();
}

std::string rate_html(const Comparison& comparison, const HorizonStage& stage) {
  return number_html(static_cast<double>(stage.unsafe) / static_cast<double>(comparison.paths)) +
         " " + interval_html(stage.unsafe_limits);
}

PageTable stage_table(const Comparison& comparison, const PlantComparison& plant) {
  PageTable table{
      .label = "Along the plan, by stage: " + plant.name,
      .heads = {"stage", "W₂ to the model, upper bound", "W₂", "floor of W₂", "certified"},
      .rows = {}};
  if (comparison.with_error) table.heads.emplace_back("with model error");
  table.heads.emplace_back("observed, 99 % interval");
  for (std::size_t k = 0; k < plant.horizon.size(); ++k) {
    const HorizonStage& stage = plant.horizon[k];
    const W2Floor& floor = comparison.floors[static_cast<std::size_t>(stage.stage)];
    std::vector<std::string> row = {
        fmt::format("{}", stage.stage), number_html(stage.w2_to_model()), number_html(stage.w2),
        plus_minus(floor.mean, floor.deviation), number_html(comparison.certificates[k].value)};
    if (comparison.with_error) row.push_back(number_html((*comparison.with_error)[k].value));
    row.push_back(rate_html(comparison, stage) +
                  (is_exceeded(plant, k) ? " <strong>exceeded</strong>" : ""));
    table.rows.push_back(std::move(row));
  }
  return table;
}

PageTable divergence_table(const PlantComparison& plant, const models::SystemDescription& system) {
  PageTable table{.label = "Divergence from the model, by stage: " + plant.name,
                  .heads = {"stage"},
                  .rows = {}};
  for (const models::Coordinate& state : system.states) table.heads.push_back(state_head(state));
  for (const HorizonStage& stage : plant.horizon) {
    std::vector<std::string> row = {fmt::format("{}", stage.stage)};
    for (const double value : stage.divergence_rmse) row.push_back(number_html(value));
    table.rows.push_back(std::move(row));
  }
  return table;
}

std::string stages_html(const Comparison& comparison, const PlantComparison& plant,
                        const models::SystemDescription& system) {
  std::string html =
      fmt::format("<details>\n<summary>Numbers by stage: {}</summary>\n", escape_html(plant.name)) +
      table_html(stage_table(comparison, plant));
  if (!is_the_model(plant)) {
    html += "<p class=\"note\">Divergence from the model, root mean square.</p>\n" +
            table_html(divergence_table(plant, system));
  }
  return html + "</details>\n";
}

std::string plan_section(const Comparison& comparison, const models::SystemDescription& system,
                         const std::vector<ComparisonFigure>& all) {
  std::string html =
      section_head("Along the plan: divergence, W₂ and its floor",
                   "Paths of each plant under one plan from the initial belief, with the same "
                   "initial states and disturbances as the model’s.");
  ComparisonFigure figure = all[kW2Figure];
  if (has_mismatch(comparison)) {
    const std::vector<Chart>& divergence = all[kDivergenceFigure].charts;
    figure.charts.insert(figure.charts.end(), divergence.begin(), divergence.end());
  }
  html += figures(figure);
  for (const PlantComparison& plant : comparison.plants) {
    html += stages_html(comparison, plant, system);
  }
  return html;
}

/// The first of the stages at which most paths are unsafe.
const HorizonStage& worst_stage(const PlantComparison& plant) {
  return *std::ranges::max_element(plant.horizon, {}, &HorizonStage::unsafe);
}

std::string certificate_section(const Comparison& comparison, const ComparisonFigure& figure) {
  PageTable table{
      .label = "Certificates against observations, by plant",
      .heads = {"plant", "stages exceeded", "worst stage", "certified there",
                "observed there, 99 % interval", "paths broken", "periods", "ended unsafe",
                certified_head(comparison), "p", "exceeded in closed loop"},
      .rows = {}};
  for (const PlantComparison& plant : comparison.plants) {
    const HorizonStage& worst = worst_stage(plant);
    const ClosedLoop& loop = plant.closed_loop;
    const double certified = comparison.in_force()[static_cast<std::size_t>(worst.stage) - 1].value;
    table.rows.push_back({escape_html(plant.name),
                          plant.exceeded_stages.empty()
                              ? fmt::format("none of {}", plant.horizon.size())
                              : "<strong>" + stages_text(plant.exceeded_stages) + "</strong>",
                          worst.unsafe > 0 ? fmt::format("{}", worst.stage) : "–",
                          worst.unsafe > 0 ? number_html(certified) : "–",
                          rate_html(comparison, worst),
                          fmt::format("{} of {}", plant.paths.faults, comparison.paths),
                          fmt::format("{}", loop.periods), fmt::format("{}", loop.unsafe_periods),
                          number_html(loop.certified_periods), number_html(loop.p_value),
                          is_exceeded_in_closed_loop(plant) ? "<strong>yes</strong>"
                          : std::isfinite(loop.p_value)     ? "no"
                                                            : "–"});
  }
  return section_head(
             fmt::format("Certificates {} model error, against observations",
                         comparison.with_error ? "with the scenario’s" : "without"),
             "Under the plan: a stage is exceeded where the whole interval of the observed share "
             "of unsafe paths lies above its certificate; the worst stage has the most unsafe "
             "paths. In closed loop: the number of periods that ended unsafe next to the sum of "
             "their certificates; p is small where there are more than the certificates allow.") +
         table_html(table) + figures(figure);
}

}  // namespace

std::string comparison_page(const Comparison& comparison) {
  const models::SystemDescription& system = comparison.system;
  const std::vector<ComparisonFigure> all = comparison_figures(comparison);
  std::string html = fmt::format("<h1>{}: {} compared with the model</h1>\n",
                                 escape_html(comparison.scenario.name),
                                 comparison.plants.size() == 1 ? "a plant" : "plants");
  html += kicker(comparison);
  if (const auto unsafe = unsafe_verdict(comparison)) html += verdict_html(*unsafe);
  if (const auto no_bound = no_bound_verdict(comparison)) html += verdict_html(*no_bound);
  html += verdict_html(comparison_verdict(comparison));
  html += closed_loop_section(comparison);
  html += certificate_section(comparison, all[kCertificateFigure]);
  html += residual_section(comparison, system, all[kResidualFigure]);
  html += plan_section(comparison, system, all);
  html += "<details>\n<summary>The scenario, with every default filled in</summary>\n<pre>" +
          escape_html(comparison.scenario_text) + "</pre>\n</details>\n";
  return framed_page({.title = comparison.scenario.name + ": comparison of plants",
                      .version = comparison.version,
                      .kind = PageKind::kTables},
                     html);
}

}  // namespace qsmpc::harness
