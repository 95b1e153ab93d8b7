#include "harness/report/episode_charts.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "controller/certification/certificate.hpp"
#include "controller/regions/safe_set.hpp"
#include "harness/assembly/assembly.hpp"
#include "harness/figures/palette.hpp"
#include "harness/text/number_format.hpp"
#include "harness/text/unit_text.hpp"
#include "models/constants.hpp"

namespace qsmpc::harness {
namespace {

constexpr double kMillisecondsPerSecond = 1e3;
constexpr const char* kTimeLabel = "time (s)";
constexpr const char* kAtFoot = "Values below the axis, including 0, are drawn at the bottom.";

std::vector<double> times_of(const Trace& trace) {
  std::vector<double> times;
  times.reserve(trace.steps.size());
  for (const StepRecord& step : trace.steps) times.push_back(step.time);
  return times;
}

/// A line through `value` of each step.
template <class Value>
Series series_of(const Trace& trace, const std::string& name, int colour, const Value& value) {
  Series series{.name = name, .colour = colour, .x = times_of(trace)};
  series.y.reserve(trace.steps.size());
  for (const StepRecord& step : trace.steps) series.y.push_back(value(step));
  return series;
}

/// The vertical extent of what is drawn, excluding limits.
Axis extent_of(const Chart& chart) {
  std::vector<double> values = chart.y_includes;
  for (const Series& series : chart.series) {
    values.insert(values.end(), series.y.begin(), series.y.end());
  }
  std::erase_if(values, [](double value) { return !is_drawable(value); });
  if (values.empty()) return {.lower = 0.0, .upper = 0.0};
  const auto [lower, upper] = std::ranges::minmax(values);
  return {.lower = lower, .upper = upper};
}

/// Whether an axis with `limit` on it would leave less than a quarter of its length to `drawn`.
bool is_beyond(const Axis& drawn, double limit) {
  constexpr double kMostStretch = 4.0;
  const double span = drawn.upper - drawn.lower;
  const double needed = std::max(drawn.upper, limit) - std::min(drawn.lower, limit);
  return span > 0.0 && needed > kMostStretch * span;
}

void add_sentence(const std::string& sentence, std::string& note) {
  note += (note.empty() ? "" : " ") + sentence;
}

/// States limits far beyond what is drawn, in `unit`, instead of drawing them.
void say_limits_beyond_the_scale(const std::string& unit, Chart& chart) {
  const Axis drawn = extent_of(chart);
  std::string said;
  std::vector<Rule> kept;
  std::string name;
  bool is_named = false;  // the group's name was already stated, or drawn
  for (const Rule& rule : chart.rules) {
    if (!rule.name.empty()) name = rule.name;
    if (is_drawable(rule.value) && is_beyond(drawn, rule.value)) {
      const bool goes_on = rule.name.empty() && !said.empty();
      said +=
          (said.empty() ? "" : ", ") + (goes_on ? "" : name + " ") + format_short(rule.value, 4);
    } else {
      is_named = is_named && rule.name.empty();
      kept.push_back({.name = is_named ? "" : name, .value = rule.value});
      is_named = true;
    }
  }
  chart.rules = std::move(kept);
  if (said.empty()) return;
  add_sentence("Beyond the scale: " + said + (unit.empty() ? "." : " " + unit + "."), chart.note);
}

Chart input_chart(const EpisodeView& view, Eigen::Index input) {
  const Trace& trace = view.trace();
  const models::Coordinate& coordinate = view.system().inputs[static_cast<std::size_t>(input)];
  const Scenario::Controller& controller = trace.scenario.controller;
  Series series = series_of(trace, "applied", kBlue, [input](const StepRecord& step) {
    return input < step.input.size() ? step.input[input] : kNotANumber;
  });
  series.mark = Mark::kSteps;
  if (!series.x.empty()) {  // hold the last value to the end of its period
    series.x.push_back(view.duration());
    series.y.push_back(series.y.back());
  }
  Chart chart{.title = "Input: " + coordinate.name,
              .x_label = kTimeLabel,
              .y_label = coordinate.name + " (" + printed_unit(coordinate.unit) + ")",
              .series = {std::move(series)}};
  if (input < controller.input_lower.size() && input < controller.input_upper.size()) {
    chart.rules = {{"bounds", controller.input_lower[input]}, {"", controller.input_upper[input]}};
    say_limits_beyond_the_scale(printed_unit(coordinate.unit), chart);
  }
  return chart;
}

/// The periods that ended unsafe, as marks at probability 1. Each mark is at the period's
/// beginning, like the certificate that refers to it.
Series unsafe_periods(const EpisodeView& view) {
  Series series{
      .name = "observed: the period ended unsafe", .colour = kOrange, .mark = Mark::kPoints};
  for (Eigen::Index k = 0; k < view.periods(); ++k) {
    if (!view.ended_unsafe(k)) continue;
    series.x.push_back(view.trace().steps[static_cast<std::size_t>(k)].time);
    series.y.push_back(1.0);
  }
  return series;
}

Chart certificate_chart(const EpisodeView& view) {
  const Trace& trace = view.trace();
  const auto next_step = [](const StepRecord& step) {
    return step.certificates.empty() ? kNotANumber : step.certificates.front().value;
  };
  const auto plan = [](const StepRecord& step) {
    return step.certificates.empty() ? kNotANumber : controller::horizon_bound(step.certificates);
  };
  const auto thesis = [](const StepRecord& step) {
    double largest = kNotANumber;
    for (const controller::StageCertificate& stage : step.certificates) {
      largest = std::fmax(largest, stage.of("thesis"));
    }
    return largest;
  };
  const bool holds = view.summary().no_bound.empty();
  Chart chart{.title = holds ? "Certificates: bounds of the probability of being unsafe"
                             : "Certificates, not bounds: see above",
              .note = kAtFoot,
              .x_label = kTimeLabel,
              .y_label = "probability (–)",
              .y_scale = Scale::kLog,
              .y_includes = {1.0},
              .series = {series_of(trace, "next step", kBlue, next_step)}};
  if (view.parts().stages > 0) {
    chart.series.push_back(series_of(trace, "plan: at any of its stages", kVermilion, plan));
  }
  chart.series.push_back(
      series_of(trace, "published method, worst stage: not a bound", kPurple, thesis));
  chart.series.back().dashed = true;
  // A limit of 0 cannot be shown on a logarithmic axis.
  const Scenario::Risk& risk = trace.scenario.risk;
  const auto add_limit = [&chart](const char* name, double limit) {
    if (!(limit > 0.0) || !std::isfinite(limit)) return;
    chart.rules.push_back({name, limit});
    chart.note += fmt::format(" Dotted: the {}, {}.", name, format_short(limit));
  };
  add_limit("limit of a stage", risk.stage);
  add_limit("limit of a plan", risk.plan);
  Series observed = unsafe_periods(view);
  chart.note = fmt::format("Observed: {} of {} periods ended unsafe. {}", observed.x.size(),
                           view.periods(), chart.note);
  if (!observed.x.empty()) chart.series.push_back(std::move(observed));
  return chart;
}

Chart clearance_chart(const EpisodeView& view) {
  const Trace& trace = view.trace();
  Series series{.name = "true state", .colour = kBlue, .x = times_of(trace)};
  series.y.assign(view.clearances().begin(), view.clearances().end());
  if (series.y.size() > series.x.size()) {
    if (trace.steps.empty()) {
      series.y.clear();
    } else {
      series.x.push_back(view.duration());
    }
  }
  return {.title = "Clearance: distance to the unsafe set",
          .x_label = kTimeLabel,
          .y_label = "clearance (" + view.clearance_unit() + ")",
          .series = {std::move(series)},
          .rules = {{"edge of the unsafe set", 0.0}}};
}

Chart budget_chart(const EpisodeView& view) {
  const Trace& trace = view.trace();
  const Scale scale = budget_scale(trace);
  const auto last = [](auto part) {
    return [part](const StepRecord& step) {
      return step.budgets.empty() ? kNotANumber : step.budgets.back().*part;
    };
  };
  Chart chart{
      .title = fmt::format("Error budget at the last stage ({})", certified_stages(view.parts())),
      .note =
          "Bound of the 2-Wasserstein distance between the model's law and its particles; what "
          "each source alone would give, and their total.",
      .x_label = kTimeLabel,
      .y_label = "W₂ distance (state units)",
      .y_scale = scale,
      .least_shown = kLeastBudget,
      .y_includes = {0.0},
      .series = {
          series_of(trace, "total", kBlue, last(&controller::StageBudget::total)),
          series_of(trace, "compression", kOrange, last(&controller::StageBudget::compression)),
          series_of(trace, "noise", kGreen, last(&controller::StageBudget::noise)),
          series_of(trace, "belief", kPurple, last(&controller::StageBudget::belief))}};
  if (trace.scenario.model_error) {
    chart.series.push_back(
        series_of(trace, "model error", kVermilion, last(&controller::StageBudget::model)));
  }
  for (std::size_t i = 1; i < chart.series.size(); ++i) chart.series[i].dashed = i % 2 == 0;
  if (scale == Scale::kLog) add_sentence(kAtFoot, chart.note);
  return chart;
}

Chart cost_chart(const Trace& trace) {
  Chart chart{.title = "Expected cost of the plan, by part",
              .note = kAtFoot,
              .x_label = kTimeLabel,
              .y_label = "cost (–)",
              .y_scale = Scale::kLog,
              .least_shown = 1e-3};
  constexpr std::array kColours = {kBlue, kGreen, kOrange, kPurple, kVermilion, kSky};
  const std::vector<controller::CostPartEntry>& parts = controller::cost_parts();
  for (std::size_t part = 0; part < parts.size(); ++part) {
    Series series = series_of(trace, parts[part].words, kColours[part % kColours.size()],
                              [part](const StepRecord& step) { return step.cost[part]; });
    series.dashed = part >= 3;
    chart.series.push_back(std::move(series));
  }
  return chart;
}

Chart timing_chart(const Trace& trace) {
  const auto part = [](auto member) {
    return [member](const StepRecord& step) { return step.timing.*member; };
  };
  Series fallbacks{
      .name = "previous plan used instead", .colour = kVermilion, .mark = Mark::kPoints};
  for (const StepRecord& step : trace.steps) {
    if (!step.fallback) continue;
    fallbacks.x.push_back(step.time);
    fallbacks.y.push_back(step.timing.total);
  }
  Chart chart{.title = "Solve time against the control period",
              .x_label = kTimeLabel,
              .y_label = "wall clock (ms)",
              .y_includes = {0.0},
              .series = {series_of(trace, "whole step", kBlue, part(&StepTiming::total)),
                         series_of(trace, "optimise", kOrange, part(&StepTiming::optimise)),
                         series_of(trace, "certify", kGreen, part(&StepTiming::certify)),
                         series_of(trace, "predict", kPurple, part(&StepTiming::propagate))},
              .rules = {{"control period", kMillisecondsPerSecond * trace.scenario.time_step}}};
  chart.series[2].dashed = true;
  chart.series[3].dashed = true;
  if (std::isfinite(trace.scenario.controller.deadline)) {
    chart.rules.push_back(
        {"deadline of a plan", kMillisecondsPerSecond * trace.scenario.controller.deadline});
  }
  if (!fallbacks.x.empty()) chart.series.push_back(std::move(fallbacks));
  say_limits_beyond_the_scale("ms", chart);
  return chart;
}

/// A vertical dashed line from 0 to `height`.
Series upright(const std::string& name, int colour, double at, double height) {
  return {.name = name, .colour = colour, .dashed = true, .x = {at, at}, .y = {0.0, height}};
}

Chart solve_time_histogram(const Trace& trace) {
  constexpr std::size_t kBins = 40;
  const double period = kMillisecondsPerSecond * trace.scenario.time_step;
  const double deadline = kMillisecondsPerSecond * trace.scenario.controller.deadline;
  double longest = 0.0;
  for (const StepRecord& step : trace.steps) {
    if (std::isfinite(step.timing.total)) longest = std::max(longest, step.timing.total);
  }
  const double width = std::max(longest, 1e-3) / kBins;
  std::vector<double> counts(kBins + 1, 0.0);  // the last entry closes the outline
  for (const StepRecord& step : trace.steps) {
    if (!std::isfinite(step.timing.total) || step.timing.total < 0.0) continue;
    ++counts[std::min(static_cast<std::size_t>(step.timing.total / width), kBins - 1)];
  }
  Series series{.name = "steps", .colour = kBlue, .mark = Mark::kSteps};
  for (std::size_t bin = 0; bin <= kBins; ++bin) {
    series.x.push_back(static_cast<double>(bin) * width);
    series.y.push_back(counts[bin]);
  }
  const double highest = *std::max_element(counts.begin(), counts.end());
  Chart chart{.title = "Solve times: histogram",
              .note = fmt::format("{} steps in {} equal bins.", trace.steps.size(), kBins),
              .x_label = "wall clock (ms)",
              .y_label = "steps (–)",
              .x_includes = {0.0},
              .y_includes = {0.0},
              .series = {std::move(series)}};
  const auto add_limit = [&](const char* name, int colour, double at) {
    if (!std::isfinite(at)) return;
    if (is_beyond({.lower = 0.0, .upper = longest}, at)) {
      add_sentence(fmt::format("Beyond the scale: {} {} ms.", name, format_short(at, 4)),
                   chart.note);
    } else {
      chart.series.push_back(upright(name, colour, at, highest));
    }
  };
  add_limit("control period", kVermilion, period);
  add_limit("deadline of a plan", kOrange, deadline);
  return chart;
}

}  // namespace

Scale budget_scale(const Trace& trace) {
  constexpr double kWide = 1e4;  // of such a range, a linear axis shows only the largest values
  double least = kInfinity;
  double largest = 0.0;
  for (const StepRecord& step : trace.steps) {
    for (const controller::StageBudget& stage : step.budgets) {
      if (!(stage.total > 0.0) || !is_drawable(stage.total)) continue;
      least = std::min(least, stage.total);
      largest = std::max(largest, stage.total);
    }
  }
  return largest > kWide * std::max(least, kLeastBudget) ? Scale::kLog : Scale::kLinear;
}

std::vector<Chart> episode_charts(const EpisodeView& view) {
  const Trace& trace = view.trace();
  const models::SystemDescription& system = view.system();
  std::vector<Chart> charts;
  charts.push_back(certificate_chart(view));
  charts.push_back(clearance_chart(view));
  for (Eigen::Index input = 0; input < std::ssize(system.inputs); ++input) {
    charts.push_back(input_chart(view, input));
  }
  charts.push_back(timing_chart(trace));
  if (view.parts().cost) charts.push_back(cost_chart(trace));
  charts.push_back(budget_chart(view));
  const double end = static_cast<double>(trace.steps.size()) * trace.scenario.time_step;
  for (Chart& chart : charts) chart.x_includes = {0.0, end};
  charts.push_back(solve_time_histogram(trace));
  return charts;
}

}  // namespace qsmpc::harness
