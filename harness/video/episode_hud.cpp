#include "harness/video/episode_hud.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <string>

#include <fmt/format.h>

#include "harness/scenario/certificate_scope.hpp"
#include "harness/text/unit_text.hpp"
#include "harness/trace/risk_use.hpp"
#include "render/hud/strip_chart.hpp"

namespace qsmpc::harness {
namespace {

constexpr double kLongestHistory = 20.0;  // s
constexpr double kShortestHistory = 2.0;  // s
constexpr double kRoom = 1.15;            // factor on a chart's range, so that nothing runs along
                                          // its edge

double next_certificate(const StepRecord& step) {
  return step.certificates.empty() ? std::numeric_limits<double>::quiet_NaN()
                                   : step.certificates.front().value;
}

// "0.00" without a sign, also for negative values that round to it.
std::string signed_text(double value) {
  std::string size = fmt::format("{:.2f}", std::abs(value));
  if (size == "0.00") return size;
  return (value < 0.0 ? "−" : "+") + size;
}

double decade_below(double value) { return std::pow(10.0, std::floor(std::log10(value))); }
double decade_above(double value) { return std::pow(10.0, std::ceil(std::log10(value))); }

/// The part of a trace that charts show.
class History {
 public:
  History(const Trace& trace, const ChartRanges& ranges, std::size_t step) : trace_(trace) {
    const double span = std::clamp(ranges.time, kShortestHistory, kLongestHistory);
    slots_ = static_cast<std::size_t>(std::ceil(span / trace.scenario.time_step - 1e-9));
    end_ = std::min(step + 1, trace.steps.size());
    begin_ = end_ > slots_ ? end_ - slots_ : 0;
  }

  [[nodiscard]] render::StripChart chart(
      std::string label, const std::function<double(const StepRecord&)>& value) const {
    render::StripChart chart;
    chart.label = std::move(label);
    chart.slots = slots_;
    for (std::size_t i = begin_; i < end_; ++i) chart.values.push_back(value(trace_.steps[i]));
    return chart;
  }

 private:
  const Trace& trace_;
  std::size_t slots_ = 0;
  std::size_t begin_ = 0;
  std::size_t end_ = 0;
};

render::StripChart certificate_chart(const History& history, const ChartRanges& ranges,
                                     double limit) {
  render::StripChart chart = history.chart("risk, next step", next_certificate);
  chart.value = bound_text(chart.values.back());
  chart.lower = ranges.least_certificate;
  chart.lower_label = percent_text(chart.lower);
  chart.upper_label = percent_text(chart.upper);
  chart.logarithmic = true;
  // A limit of 0 cannot be shown on a logarithmic axis.
  if (limit > 0.0 && std::isfinite(limit)) {
    chart.limit = {.value = limit, .label = "limit " + percent_text(limit)};
  }
  return chart;
}

render::StripChart input_chart(const History& history, const Scenario::Controller& controller,
                               const models::SystemDescription& system, Eigen::Index index) {
  const models::Coordinate& input = system.inputs[static_cast<std::size_t>(index)];
  render::StripChart chart =
      history.chart(fmt::format("{} [{}]", input.name, printed_unit(input.unit)),
                    [index](const StepRecord& step) { return step.input[index]; });
  chart.value = signed_text(chart.values.back());
  const bool bounded = controller.input_lower.size() > 0 && controller.input_upper.size() > 0;
  chart.lower = bounded ? controller.input_lower[index] : system.input_lower[index];
  chart.upper = bounded ? controller.input_upper[index] : system.input_upper[index];
  return chart;
}

render::StripChart cost_chart(const History& history, const ChartRanges& ranges) {
  render::StripChart chart =
      history.chart("cost of plan", [](const StepRecord& step) { return step.cost.total(); });
  chart.value = render::short_number(chart.values.back());
  chart.lower = ranges.least_cost;
  chart.upper = ranges.largest_cost;
  chart.logarithmic = ranges.least_cost > 0.0;
  return chart;
}

render::StripChart solve_time_chart(const History& history, const Scenario& scenario,
                                    const ChartRanges& ranges) {
  constexpr double kMillisecondsPerSecond = 1000.0;
  render::StripChart chart =
      history.chart("planning time [ms]", [](const StepRecord& step) { return step.timing.total; });
  chart.value = fmt::format("{:.0f}", chart.values.back());
  const bool deadline = std::isfinite(scenario.controller.deadline);
  const double limit =
      kMillisecondsPerSecond * (deadline ? scenario.controller.deadline : scenario.time_step);
  chart.limit = {.value = limit,
                 .label = fmt::format("{} {:.3g}", deadline ? "deadline" : "period", limit)};
  chart.upper = kRoom * std::max(limit, ranges.largest_solve_time);
  return chart;
}

/// Present in all frames if there are limits: rows that come and go would shift the charts.
void add_risk_rows(const Trace& trace, std::size_t step, std::vector<render::HudRow>& rows) {
  const Scenario::Risk& limits = trace.scenario.risk;
  if (!limits.any()) return;
  const bool exceeded = exceeds_limits(trace.steps[step], limits);
  rows.push_back(
      {.name = "risk limit", .value = exceeded ? "exceeded" : "kept", .warning = exceeded});
  if (!std::isfinite(limits.mission)) return;
  double spent = 0.0;
  for (std::size_t k = 0; k <= step; ++k) {
    if (!trace.steps[k].certificates.empty()) spent += next_certificate(trace.steps[k]);
  }
  rows.push_back({.name = "risk spent",
                  .value = percent_text(spent) + " of " + percent_text(limits.mission),
                  .warning = spent > limits.mission});
}

}  // namespace

std::string percent_text(double probability) {
  constexpr double kPercent = 100.0;
  return render::short_number(kPercent * probability) + " %";
}

std::string bound_text(double bound) {
  constexpr double kLeastShown = 1e-5;
  if (std::isnan(bound)) return "–";
  if (bound >= 1.0) return "≤ 100 %";
  if (bound <= kLeastShown) return "≤ " + percent_text(kLeastShown);
  // Two digits, rounded up, so that an upper bound remains one. A mere rounding error above a
  // two-digit value is ignored.
  constexpr double kRounding = 1e-9;
  const double unit = std::pow(10.0, std::floor(std::log10(bound)) - 1.0);
  return "≤ " + percent_text(std::min(std::ceil(bound / unit * (1.0 - kRounding)) * unit, 1.0));
}

ChartRanges chart_ranges(const EpisodeView& view) {
  constexpr double kLowestFloor = 1e-9;
  const Trace& trace = view.trace();
  ChartRanges ranges;
  if (trace.steps.empty()) return ranges;
  ranges.time = view.duration();
  double least = std::numeric_limits<double>::infinity();
  double largest = -least;
  for (const StepRecord& step : trace.steps) {
    const double certificate = next_certificate(step);
    if (certificate > 0.0) {
      ranges.least_certificate = std::min(ranges.least_certificate, decade_below(certificate));
    }
    ranges.largest_solve_time = std::max(ranges.largest_solve_time, step.timing.total);
    least = std::min(least, step.cost.total());
    largest = std::max(largest, step.cost.total());
  }
  const double limit = trace.scenario.risk.stage;
  if (limit > 0.0)
    ranges.least_certificate = std::min(ranges.least_certificate, decade_below(limit));
  ranges.least_certificate = std::max(ranges.least_certificate, kLowestFloor);
  ranges.least_cost = least > 0.0 ? decade_below(least) : 0.0;
  ranges.largest_cost = largest > 0.0 ? decade_above(largest * kRoom) : 1.0;
  return ranges;
}

ChartRanges united(const ChartRanges& a, const ChartRanges& b) {
  return {.time = std::max(a.time, b.time),
          .least_certificate = std::min(a.least_certificate, b.least_certificate),
          .least_cost = std::min(a.least_cost, b.least_cost),
          .largest_cost = std::max(a.largest_cost, b.largest_cost),
          .largest_solve_time = std::max(a.largest_solve_time, b.largest_solve_time)};
}

std::vector<render::StripChart> strip_charts(const EpisodeView& view, const ChartRanges& ranges,
                                             std::size_t step) {
  const Trace& trace = view.trace();
  const Scenario& scenario = view.scenario();
  const models::SystemDescription& system = view.system();
  const History history(trace, ranges, step);
  std::vector<render::StripChart> charts;
  if (!trace.steps[step].certificates.empty()) {
    charts.push_back(certificate_chart(history, ranges, scenario.risk.stage));
    if (!view.summary().no_bound.empty()) {
      charts.back().label = "next step, no bound";
      charts.back().value = percent_text(charts.back().values.back());
    }
  }
  if (!system.inputs.empty()) {
    charts.push_back(input_chart(history, scenario.controller, system, 0));
  }
  if (std::isfinite(trace.steps[step].cost.total())) charts.push_back(cost_chart(history, ranges));
  charts.push_back(solve_time_chart(history, scenario, ranges));
  if (system.inputs.size() > 1) {
    charts.push_back(input_chart(history, scenario.controller, system, 1));
  }
  return charts;
}

std::vector<render::HudRow> hud_rows(const Trace& trace, std::size_t index, double time,
                                     double speed) {
  const StepRecord& step = trace.steps[index];
  std::vector<render::HudRow> rows{{"time", fmt::format("{:.1f} s", time)},
                                   {"speed", fmt::format("{:.2f} m/s", speed)}};
  if (!step.certificates.empty() && step.plan_states.cols() > 1) {
    const double bound = controller::horizon_bound(step.certificates);
    const bool holds = why_no_bound(trace.scenario).empty();
    rows.push_back(holds ? render::HudRow{"risk of plan", bound_text(bound)}
                         : render::HudRow{"plan, no bound", percent_text(bound)});
  }
  add_risk_rows(trace, index, rows);
  if (step.fallback) rows.push_back({"applied", "previous plan"});
  return rows;
}

}  // namespace qsmpc::harness
