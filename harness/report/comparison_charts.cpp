#include "harness/report/comparison_charts.hpp"

#include <algorithm>
#include <cstddef>
#include <utility>

#include <fmt/format.h>

#include "harness/figures/palette.hpp"
#include "harness/text/unit_text.hpp"

namespace qsmpc::harness {
namespace {

constexpr const char* kStageLabel = "stage";
constexpr double kLeastResidual = 1e-9;      // smaller values are drawn at the foot of the axis
constexpr double kLeastProbability = 1e-10;  // the same
constexpr std::ptrdiff_t kMostWithUnit = 4;  // most states whose units have room below the axis
constexpr double kSpread = 0.24;  // spread of the points to the left and right of a state's name

/// Colours of the plants; blue is reserved for what they are compared with.
int plant_colour(std::size_t plant) { return 1 + static_cast<int>(plant) % (kPaletteSize - 1); }

std::string with_unit(const models::Coordinate& coordinate) {
  return coordinate.unit.empty() ? coordinate.name
                                 : coordinate.name + " (" + printed_unit(coordinate.unit) + ")";
}

/// Values at the names of the states, offset by `beside`, a fraction of the distance between names.
Series by_coordinate(const std::string& name, int colour, const Eigen::VectorXd& values,
                     double beside) {
  Series series{.name = name, .colour = colour, .mark = Mark::kPoints};
  for (Eigen::Index i = 0; i < values.size(); ++i) {
    series.x.push_back(static_cast<double>(i + 1) + beside);
    series.y.push_back(values[i]);
  }
  return series;
}

ComparisonFigure residual_figure(const Comparison& comparison,
                                 const models::SystemDescription& system) {
  Chart chart{.title = "One-step residual: what the plant adds to model and disturbance",
              .note =
                  "Root mean square over all periods of all episodes. The part of the plant's next "
                  "state that the model and the disturbance do not explain. Values below 10⁻⁹, "
                  "such as rounding errors, are drawn at the bottom.",
              .x_label = "state",
              .y_label = "root mean square (unit of the state)",
              .y_scale = Scale::kLog,
              .least_shown = kLeastResidual};
  for (const models::Coordinate& state : system.states) {
    const bool has_room = std::ssize(system.states) <= kMostWithUnit;
    chart.x_names.push_back(has_room ? with_unit(state) : state.name);
  }
  chart.x_includes = {0.5, static_cast<double>(system.states.size()) + 0.5};
  chart.series.push_back(
      by_coordinate("disturbance, for scale", kBlue,
                    comparison.scenario.disturbance.covariance.diagonal().cwiseSqrt(), -kSpread));
  const double step = 2.0 * kSpread / static_cast<double>(comparison.plants.size());
  for (std::size_t n = 0; n < comparison.plants.size(); ++n) {
    const PlantComparison& plant = comparison.plants[n];
    chart.series.push_back(by_coordinate(plant.name, plant_colour(n), plant.one_step.rmse,
                                         step * static_cast<double>(n + 1) - kSpread));
  }
  return {.file = "residuals.svg", .charts = {std::move(chart)}};
}

/// A line through `value` of each stage of `plant`.
template <class Value>
Series by_stage(const PlantComparison& plant, const std::string& name, int colour,
                const Value& value) {
  Series series{.name = name, .colour = colour};
  for (const HorizonStage& stage : plant.horizon) {
    series.x.push_back(stage.stage);
    series.y.push_back(value(stage));
  }
  return series;
}

ComparisonFigure divergence_figure(const Comparison& comparison,
                                   const models::SystemDescription& system) {
  ComparisonFigure figure{.file = "divergence.svg", .charts = {}};
  for (Eigen::Index i = 0; i < std::ssize(system.states); ++i) {
    const models::Coordinate& state = system.states[static_cast<std::size_t>(i)];
    Chart chart{.title = "Divergence from the model: " + state.name,
                .note = "Root mean square over paths with the same disturbances.",
                .x_label = kStageLabel,
                .y_label = with_unit(state),
                .x_includes = {0.0},
                .y_includes = {0.0}};
    for (std::size_t n = 0; n < comparison.plants.size(); ++n) {
      const PlantComparison& plant = comparison.plants[n];
      chart.series.push_back(
          by_stage(plant, plant.name, plant_colour(n),
                   [i](const HorizonStage& stage) { return stage.divergence_rmse[i]; }));
    }
    figure.charts.push_back(std::move(chart));
  }
  return figure;
}

ComparisonFigure w2_figure(const Comparison& comparison) {
  Chart chart{.title = "W₂ between the predicted measure and the plant",
              .note = fmt::format(
                  "Floor: the same distance for {} of the model itself, mean and two standard "
                  "deviations over {} ensembles. A plant within it cannot be distinguished from "
                  "the model.",
                  comparison.w2_paths > 0 ? fmt::format("{} paths", comparison.w2_paths) : "paths",
                  kFloorEnsembles),
              .x_label = kStageLabel,
              .y_label = "W₂ distance (state units)",
              .x_includes = {0.0},
              .y_includes = {0.0}};
  Series floor{.name = "floor: the model", .colour = kBlue};
  Series lower{.name = "floor − 2σ", .colour = kBlue, .dashed = true};
  Series upper{.name = "floor + 2σ", .colour = kBlue, .dashed = true};
  for (std::size_t k = 1; k < comparison.floors.size(); ++k) {
    const W2Floor& of_stage = comparison.floors[k];
    for (Series* series : {&floor, &lower, &upper}) series->x.push_back(static_cast<double>(k));
    floor.y.push_back(of_stage.mean);
    lower.y.push_back(std::max(0.0, of_stage.mean - 2.0 * of_stage.deviation));
    upper.y.push_back(of_stage.mean + 2.0 * of_stage.deviation);
  }
  chart.series = {floor, lower, upper};
  for (std::size_t n = 0; n < comparison.plants.size(); ++n) {
    chart.series.push_back(by_stage(comparison.plants[n], comparison.plants[n].name,
                                    plant_colour(n),
                                    [](const HorizonStage& stage) { return stage.w2; }));
  }
  return {.file = "w2.svg", .charts = {std::move(chart)}};
}

/// Adds a point with its interval for each stage, at 0 if no path is unsafe.
void add_observed(const Comparison& comparison, const PlantComparison& plant, Chart& chart) {
  Series seen{.name = "observed, 99 % interval", .colour = kVermilion, .mark = Mark::kPoints};
  Series unseen{
      .name = "none observed, 99 % interval", .colour = kVermilion, .mark = Mark::kPoints};
  for (const HorizonStage& stage : plant.horizon) {
    if (stage.unsafe == 0) {
      unseen.x.push_back(stage.stage);
      unseen.y.push_back(0.0);
      unseen.lower.push_back(0.0);
      unseen.upper.push_back(stage.unsafe_limits.upper);
      continue;
    }
    seen.x.push_back(stage.stage);
    seen.y.push_back(static_cast<double>(stage.unsafe) / static_cast<double>(comparison.paths));
    seen.lower.push_back(stage.unsafe_limits.lower);
    seen.upper.push_back(stage.unsafe_limits.upper);
  }
  for (Series* series : {&unseen, &seen}) {
    if (!series->x.empty()) chart.series.push_back(std::move(*series));
  }
}

Chart certificate_chart(const Comparison& comparison, const PlantComparison& plant) {
  const auto of = [](const std::vector<controller::StageCertificate>& certificates) {
    return [&certificates](const HorizonStage& stage) {
      return certificates[static_cast<std::size_t>(stage.stage) - 1].value;
    };
  };
  Chart chart{.title = "Certificates: " + plant.name,
              .note =
                  "Bounds of the probability of being unsafe under the plan, and the share of the "
                  "plant's paths that are unsafe. A bound is exceeded where a whole interval lies "
                  "above it.",
              .x_label = kStageLabel,
              .y_label = "probability (–)",
              .y_scale = Scale::kLog,
              .least_shown = kLeastProbability,
              .y_has_zero = true,
              .x_includes = {0.0},
              .y_includes = {1.0}};
  chart.series.push_back(
      by_stage(plant, "certificate without model error", kBlue, of(comparison.certificates)));
  if (comparison.with_error) {
    chart.series.push_back(
        by_stage(plant, "certificate with model error", kGreen, of(*comparison.with_error)));
  }
  add_observed(comparison, plant, chart);
  return chart;
}

}  // namespace

std::vector<ComparisonFigure> comparison_figures(const Comparison& comparison) {
  const models::SystemDescription& system = comparison.system;
  ComparisonFigure certificates{.file = "certificates.svg", .charts = {}};
  for (const PlantComparison& plant : comparison.plants) {
    certificates.charts.push_back(certificate_chart(comparison, plant));
  }
  return {residual_figure(comparison, system), divergence_figure(comparison, system),
          w2_figure(comparison), std::move(certificates)};
}

}  // namespace qsmpc::harness
