#include "harness/reproduction/drive_figures.hpp"

#include <algorithm>
#include <cstddef>
#include <functional>

#include <fmt/format.h>

#include "harness/figures/ground_map.hpp"
#include "harness/figures/palette.hpp"
#include "harness/reproduction/published_way.hpp"
#include "harness/text/unit_text.hpp"

namespace qsmpc::harness {
namespace {

constexpr int kEllipsePeriod = 12;  // periods from one drawn belief to the next
constexpr double kEllipseLevel = 0.95;
constexpr double kLeastChartedProbability = 1e-8;  // of a probability
constexpr const char* kTimeLabel = "time (s)";

MapPath path_of(const Eigen::MatrixXd& states, const models::SystemDescription& system) {
  MapPath path;
  for (Eigen::Index k = 0; k < states.cols(); ++k) {
    path.points.push_back(map_point(states.col(k), system));
  }
  return path;
}

MapEllipse ellipse_of(const Eigen::VectorXd& mean, const Eigen::MatrixXd& covariance,
                      const models::SystemDescription& system) {
  const auto x = system.position_x;
  const auto y = system.position_y;
  MapEllipse ellipse{.levels = {kEllipseLevel}};
  ellipse.mean << mean[x], mean[y];
  ellipse.covariance << covariance(x, x), covariance(x, y), covariance(y, x), covariance(y, y);
  return ellipse;
}

void add_beliefs(const Sample& sample, const models::SystemDescription& system, PlaneMap& map) {
  const Scenario& scenario = sample.scenario;
  for (std::size_t k = 0; k < sample.first.steps.size(); k += kEllipsePeriod) {
    const StepRecord& step = sample.first.steps[k];
    MapEllipse belief = ellipse_of(step.belief_mean, step.belief_covariance, system);
    belief.name = "belief, 95 %";
    belief.colour = kBlue;
    const StageParticles& last = step.particles.back();
    MapEllipse predicted =
        ellipse_of(controller::mean_of(last), controller::covariance_of(last), system);
    predicted.name =
        fmt::format("{:.1f} s ahead, 95 %", scenario.controller.horizon * scenario.time_step);
    predicted.colour = kOrange;
    map.ellipses.push_back(predicted);
    map.ellipses.push_back(belief);
  }
}

/// One series per sample, of its first drive: the value of period k at the time of period k.
std::vector<Series> first_drives(
    const std::vector<NamedSample>& samples, Mark mark,
    const std::function<std::vector<double>(const EpisodeDigest&)>& values) {
  std::vector<Series> all;
  for (const NamedSample& named : samples) {
    Series series{
        .name = named.name, .colour = static_cast<int>(all.size()) % kPaletteSize, .mark = mark};
    series.y = values(named.sample->episodes.front());
    for (std::size_t k = 0; k < series.y.size(); ++k) {
      series.x.push_back(static_cast<double>(k) * named.sample->scenario.time_step);
    }
    all.push_back(std::move(series));
  }
  return all;
}

std::vector<double> row_of(const Eigen::MatrixXd& matrix, Eigen::Index row) {
  std::vector<double> values;
  for (Eigen::Index k = 0; k < matrix.cols(); ++k) values.push_back(matrix(row, k));
  return values;
}

/// The mean for each period k over the drives that have it.
Series mean_series(const NamedSample& named, std::vector<double> EpisodeDigest::*values) {
  Series series{.name = named.name};
  for (std::size_t k = 0;; ++k) {
    double sum = 0.0;
    int count = 0;
    for (const EpisodeDigest& episode : named.sample->episodes) {
      if (k >= (episode.*values).size()) continue;
      sum += (episode.*values)[k];
      ++count;
    }
    if (count == 0) return series;
    series.x.push_back(static_cast<double>(k) * named.sample->scenario.time_step);
    series.y.push_back(sum / count);
  }
}

Chart mean_chart(const std::string& title, const std::vector<NamedSample>& samples,
                 std::vector<double> EpisodeDigest::*values) {
  Chart chart{.title = title,
              .note = fmt::format("mean over those of the {} drives that are still under way",
                                  samples.front().sample->episodes.size()),
              .x_label = kTimeLabel,
              .y_label = "P(unsafe)",
              .y_scale = Scale::kLog,
              .least_shown = kLeastChartedProbability};
  for (const NamedSample& named : samples) {
    chart.series.push_back(mean_series(named, values));
    chart.series.back().colour = static_cast<int>(chart.series.size() - 1) % kPaletteSize;
  }
  return chart;
}

}  // namespace

PlaneMap drive_map(const std::string& title, const Sample& sample) {
  const models::SystemDescription& system = sample.first.system;
  PlaneMap map = ground_map(sample.scenario, system);
  map.title = title;
  for (std::size_t n = 1; n < sample.episodes.size(); ++n) {
    MapPath path = path_of(sample.episodes[n].states, system);
    path.name = "the other drives";
    path.colour = kGrey;
    path.faint = true;
    map.paths.push_back(std::move(path));
  }
  MapPath first = path_of(sample.episodes.front().states, system);
  first.name = fmt::format("seed {}, from dot to square", sample.episodes.front().seed);
  first.colour = kInk;
  first.start_mark = MapMark::kDot;
  first.end_mark = MapMark::kSquare;
  map.paths.push_back(std::move(first));
  add_beliefs(sample, system, map);
  return map;
}

/// A chart of `coordinate` over time, still empty.
Chart coordinate_chart(const std::string& kind, const models::Coordinate& coordinate) {
  return {.title = kind + ": " + coordinate.name,
          .x_label = kTimeLabel,
          .y_label = coordinate.name + " (" + printed_unit(coordinate.unit) + ")"};
}

std::vector<Chart> input_charts(const std::vector<NamedSample>& samples) {
  const Sample& sample = *samples.front().sample;
  const std::vector<models::Coordinate>& inputs = sample.first.system.inputs;
  std::vector<Chart> charts;
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    Chart& chart = charts.emplace_back(coordinate_chart("Input", inputs[i]));
    chart.series = first_drives(samples, Mark::kSteps, [&](const EpisodeDigest& episode) {
      return row_of(episode.inputs, row);
    });
    chart.rules = {{.name = "bounds", .value = sample.scenario.controller.input_lower[row]},
                   {.name = "", .value = sample.scenario.controller.input_upper[row]}};
  }
  return charts;
}

std::vector<Chart> state_charts(const std::vector<NamedSample>& samples) {
  const Sample& sample = *samples.front().sample;
  const std::vector<models::Coordinate>& states = sample.first.system.states;
  std::vector<Chart> charts;
  for (std::size_t i = 0; i < states.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    Chart& chart = charts.emplace_back(coordinate_chart("State", states[i]));
    chart.series = first_drives(samples, Mark::kLine, [&](const EpisodeDigest& episode) {
      return row_of(episode.states, row);
    });
    chart.rules = {{.name = "target", .value = sample.scenario.target.state[row]}};
  }
  return charts;
}

Chart cost_chart(const std::vector<NamedSample>& samples) {
  return {.title = "Expected cost of the plan",
          .x_label = kTimeLabel,
          .y_label = "cost",
          .y_scale = Scale::kLog,
          .series = first_drives(samples, Mark::kLine,
                                 [](const EpisodeDigest& episode) { return episode.costs; })};
}

Chart risk_chart(const std::string& title, const Sample& sample) {
  const std::vector<NextStepView> views = next_step_views(sample.first);
  Chart chart{.title = title,
              .note =
                  "next step of the first drive; the published value is not a bound, the "
                  "others are",
              .x_label = kTimeLabel,
              .y_label = "P(unsafe)",
              .y_scale = Scale::kLog,
              .least_shown = kLeastChartedProbability};
  const auto add = [&](const std::string& name, int colour, bool dashed,
                       const std::function<double(std::size_t)>& value) {
    Series series{.name = name, .colour = colour, .dashed = dashed};
    for (std::size_t k = 0; k < views.size(); ++k) {
      series.x.push_back(static_cast<double>(k) * sample.scenario.time_step);
      series.y.push_back(value(k));
    }
    chart.series.push_back(std::move(series));
  };
  add("as published, plain", kVermilion, false,
      [&](std::size_t k) { return views[k].plain.published; });
  add("as published, compressed", kOrange, true,
      [&](std::size_t k) { return views[k].compressed.published; });
  add("C1, plain", kSky, false, [&](std::size_t k) { return views[k].plain.sound; });
  add("C1, compressed", kPurple, true, [&](std::size_t k) { return views[k].compressed.sound; });
  add("certificate in force", kBlue, false,
      [&](std::size_t k) { return sample.episodes.front().next_step[k]; });
  return chart;
}

Chart certified_chart(const std::vector<NamedSample>& samples) {
  return mean_chart("P(unsafe) of the next step, certified", samples, &EpisodeDigest::next_step);
}

Chart published_chart(const std::vector<NamedSample>& samples) {
  return mean_chart("P(unsafe) of the next step, the published way", samples,
                    &EpisodeDigest::published);
}

}  // namespace qsmpc::harness
