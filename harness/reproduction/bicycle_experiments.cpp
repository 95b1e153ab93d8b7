// Table 5-5 with Fig. 5-5, and Fig. 5-6: the bicycle among obstacles.

#include <array>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "harness/reproduction/drive_figures.hpp"
#include "harness/reproduction/drive_rows.hpp"
#include "harness/reproduction/experiments.hpp"
#include "harness/statistics/sample_statistics.hpp"

namespace qsmpc::harness {
namespace {

constexpr const char* kScenario = "bicycle_square";

struct PointsColumn {
  int points;  // products that exist; the table calls them 100, 500 and 1000
  double optimisation_s;
  double unsafe;
};
constexpr std::array<PointsColumn, 3> kColumns{
    {{96, 213.57, 0.053}, {486, 246.96, 0.046}, {972, 311.43, 0.034}}};
constexpr double kSimulated = 9.9;  // s, of every column

constexpr double kNoisyHours = 1.3;
constexpr double kSecondsAnHour = 3600.0;

std::vector<Panel> panels_along(const std::vector<NamedSample>& samples) {
  std::vector<Panel> panels;
  for (const Chart& chart : input_charts(samples)) panels.emplace_back(chart);
  panels.emplace_back(cost_chart(samples));
  panels.emplace_back(certified_chart(samples));
  panels.emplace_back(published_chart(samples));
  return panels;
}

}  // namespace

ExperimentResult bicycle_by_points(Laboratory& laboratory) {
  ExperimentResult result;
  std::vector<const Sample*> samples;
  for (const PointsColumn& published : kColumns) {
    const PublishedDrive column{
        .name = fmt::format("{} points", published.points),
        .variant = {.scenario = kScenario,
                    .overrides = {fmt::format("controller.quantisation.state={}",
                                              published.points)}},
        .reached_s = kSimulated,
        .optimisation_s = published.optimisation_s,
        .unsafe = published.unsafe};
    samples.push_back(&laboratory.sample(column.variant));
    add_drive_rows(column, *samples.back(), result);
  }
  add_points_claims("L-BFGS", samples, result);
  std::vector<NamedSample> by_points;
  for (std::size_t n = 0; n < samples.size(); ++n) {
    by_points.push_back({fmt::format("{} points", kColumns[n].points), samples[n]});
  }
  result.figures = {{.file = "figure-5-5-drives.svg",
                     .title = "Drives of the bicycle",
                     .caption = kMapCaption,
                     .panels = {drive_map(by_points.front().name, *samples.front()),
                                drive_map(by_points.back().name, *samples.back())}},
                    {.file = "figure-5-5-inputs.svg",
                     .title = "Inputs, cost and probabilities",
                     .caption = "Inputs and cost of the first drive of each.",
                     .panels = panels_along(by_points)}};
  result.remarks = {
      "Blocks, speeds and noise are chosen here, because the thesis does not print them. With the "
      "weights of its Table B-3 most drives leave the safe set; scenario bicycle_square says which "
      "differ and why. One of the seeds 0 to 49 draws a start below the minimum speed and counts "
      "as unsafe."};
  return result;
}

ExperimentResult bicycle_with_noise(Laboratory& laboratory) {
  ExperimentResult result;
  const PublishedDrive column{
      .name = "full noise",
      .variant = {.scenario = kScenario, .overrides = {"controller.propagate_noise=true"}},
      .optimisation_s = kNoisyHours * kSecondsAnHour};
  const Sample& sample = laboratory.sample(column.variant);
  add_drive_rows(column, sample, result);
  const double periods = kSimulated / sample.scenario.time_step;
  const auto row = [&](const std::string& reading, double published) {
    result.rows.push_back({.quantity = "full noise: optimisation time of a problem, " + reading,
                           .unit = "s",
                           .published = published,
                           .here = median_plan_seconds(sample),
                           .place = TablePlace{.table = "",
                                               .row = "optimisation time of a problem, " + reading,
                                               .column = "full noise"}});
  };
  row("1.3 h for one drive (the caption)", kNoisyHours * kSecondsAnHour / periods);
  row("1.3 h for ten drives (the text)", 0.1 * kNoisyHours * kSecondsAnHour / periods);
  const std::vector<NamedSample> one{{"full noise", &sample}};
  result.figures = {{.file = "figure-5-6.svg",
                     .title = "The bicycle with noise and compression",
                     .caption = kMapCaption,
                     .panels = panels_along(one)}};
  result.figures.front().panels.insert(
      result.figures.front().panels.begin(),
      {Panel(drive_map("Drives", sample)),
       Panel(risk_chart("Probability of the unsafe set", sample))});
  return result;
}

}  // namespace qsmpc::harness
