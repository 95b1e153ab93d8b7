#include "harness/prediction/law_table.hpp"

#include <cmath>
#include <cstddef>

#include <fmt/format.h>

#include "harness/text/number_format.hpp"

namespace qsmpc::harness {
namespace {

std::string error_cell(double value) {
  if (!std::isfinite(value)) return "-";
  return is_plain_in_table(value) ? fmt::format("{:.3f}", value) : fmt::format("{:.2e}", value);
}

std::string table_row(const std::string& name, const LawErrors& errors, const std::string& time) {
  return fmt::format("  {:<18}{:>10}{:>10}{:>12}{:>12}{:>10}\n", name, error_cell(errors.w2),
                     error_cell(errors.mean), error_cell(errors.covariance),
                     fmt::format("{:.2e}", errors.unsafe), time);
}

std::string stage_rows(const PredictionReport& report, std::size_t stage) {
  const LawComparison& laws = *report.laws;
  const LawFloor& floor = laws.floors[stage - 1];
  const SimulatedRate truth =
      simulated_rate(report.monte_carlo->stages[stage - 1], report.monte_carlo->samples);
  std::string text = fmt::format("Stage {}, against {} paths; P(unsafe) from {:.2e} to {:.2e}\n",
                                 stage, laws.truth.samples, truth.limits.lower, truth.limits.upper);
  text += fmt::format("  {:<18}{:>10}{:>10}{:>12}{:>12}{:>10}\n", "method", "W2", "mean",
                      "covariance", "P(unsafe)", "ms");
  text += table_row(
      "(sampling)",
      {.w2 = floor.w2, .mean = floor.mean, .covariance = floor.covariance, .unsafe = truth.rate},
      "-");
  for (const MethodErrors& method : laws.methods) {
    text += table_row(method.name, method.stages[stage - 1], error_cell(method.milliseconds));
  }
  return text;
}

}  // namespace

std::string law_table(const PredictionReport& report, const std::vector<int>& stages) {
  if (!report.laws) return "";
  std::string text;
  if (stages.empty()) text = stage_rows(report, report.laws->floors.size());
  for (const int stage : stages) text += stage_rows(report, static_cast<std::size_t>(stage));
  text += fmt::format(
      "W2: to {} of the paths; the first row is the error of sampling alone.\n"
      "covariance: relative. ms: the whole horizon, one thread, median of up to {} runs.\n",
      kTransportPaths, kTimedRuns);
  return text;
}

}  // namespace qsmpc::harness
