// Algorithms 3 and 4: the probability of the unsafe set as published, and bounds that hold.

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "controller/certification/published_certificate.hpp"
#include "harness/figures/palette.hpp"
#include "harness/reproduction/experiments.hpp"
#include "harness/reproduction/turn_prediction.hpp"

namespace qsmpc::harness {
namespace {

constexpr int kStages = 8;
constexpr double kLeastShown = 1e-8;

/// A turn past something, and the stage at which it is looked at closely.
struct Case {
  std::string name;
  int stage = 0;
  PredictionReport report;
};

SimulatedRate truth_at(const PredictionReport& report, int stage) {
  return simulated_rate(report.monte_carlo->stages[static_cast<std::size_t>(stage) - 1],
                        report.monte_carlo->samples);
}

/// Algorithm 4 with the true distance, and the radius that holds.
double linear_transport_at(const PredictionReport& report, int stage) {
  const auto k = static_cast<std::size_t>(stage);
  return controller::linear_transport_probability(
      report.prediction.stages[k], report.scenario.safe_set, report.budgets[k].total);
}

const controller::StageCertificate& certificate_at(const PredictionReport& report, int stage) {
  return report.certificates[static_cast<std::size_t>(stage) - 1];
}

void add_rows(const Case& turn, ExperimentResult& result) {
  const controller::StageCertificate& certificate = certificate_at(turn.report, turn.stage);
  const SimulatedRate truth = truth_at(turn.report, turn.stage);
  const auto row = [&](const std::string& what, double value, const std::string& note = {}) {
    result.rows.push_back(
        {.quantity = fmt::format("P(unsafe), {}, stage {}: {}", turn.name, turn.stage, what),
         .here = value,
         .note = note,
         .place = TablePlace{.table = "P(unsafe)",
                             .row = what,
                             .column = fmt::format("{}, stage {}", turn.name, turn.stage)}});
  };
  row("truth", truth.rate,
      fmt::format("{} samples; at least {:.3g} and at most {:.3g}, each wrong with probability {}",
                  turn.report.monte_carlo->samples, truth.limits.lower, truth.limits.upper,
                  kRateTail));
  row("as published (Eq. 4-4, Algorithms 3 and 4)", certificate.of("thesis"),
      certificate.of("thesis") < truth.limits.lower ? "below the truth: not a bound" : "");
  row("Algorithm 4, distance and radius right", linear_transport_at(turn.report, turn.stage),
      "a bound, but loose");
  row("C1, transport cost right too", certificate.of("c1"), "a bound");
  row("C2, Gaussian noise kept", certificate.of("c2"), "a bound");
  row("C3, Gaussian surrogate", certificate.of("c3"), "a bound");
  row("C4, the same smoothed", certificate.of("c4"), "a bound");
  row("C5, C4 given what bends the motion most", certificate.of("c5"),
      "a bound; the smallest of the five is in force");
}

Chart chart_of(const Case& turn) {
  Chart chart{.title = "P(unsafe) along the turn, " + turn.name,
              .x_label = "stage",
              .y_label = "P(unsafe)",
              .y_scale = Scale::kLog,
              .least_shown = kLeastShown};
  const auto add = [&](const std::string& name, int colour, const std::function<double(int)>& value,
                       bool dashed = false) {
    Series series{.name = name, .colour = colour, .dashed = dashed};
    for (int stage = 1; stage <= kStages; ++stage) {
      series.x.push_back(stage);
      series.y.push_back(value(stage));
    }
    chart.series.push_back(series);
  };
  const auto certificate = [&](const std::string& key) {
    return [&turn, key](int stage) { return certificate_at(turn.report, stage).of(key); };
  };
  add("truth", kGreen, [&](int stage) { return truth_at(turn.report, stage).rate; });
  add(
      "its lower limit", kGreen,
      [&](int stage) { return truth_at(turn.report, stage).limits.lower; }, true);
  add("as published", kVermilion, certificate("thesis"), true);
  add("C1", kSky, certificate("c1"));
  add("C2", kOrange, certificate("c2"));
  add("C3", kPurple, certificate("c3"));
  add("C4", kBlue, certificate("c4"));
  add("C5", kInk, certificate("c5"));
  return chart;
}

}  // namespace

ExperimentResult published_certificate(Laboratory& laboratory) {
  ExperimentResult result;
  const auto turn_past = [&](const std::string& name, int stage,
                             const std::vector<std::string>& overrides) {
    laboratory.at_work("the published probability, " + name);
    return Case{.name = name,
                .stage = stage,
                .report = on_a_turn(kStages, overrides, laboratory.truth_samples())};
  };
  const Case walls = turn_past("walls alone", kStages, {});
  const Case block =
      turn_past("a block ahead", 3, {"safe_set.obstacles=[{x: [0.4, 3], y: [-0.5, 2]}]"});
  add_rows(walls, result);
  add_rows(block, result);

  result.claims.push_back(
      {.statement = "The certificate in force is never below the truth, at any stage of either",
       .holds =
           contradicted_stages(walls.report).empty() && contradicted_stages(block.report).empty(),
       .evidence = fmt::format("{} samples, each limit wrong with probability {}",
                               laboratory.truth_samples(), kRateTail)});
  const double published = certificate_at(block.report, block.stage).of("thesis");
  const SimulatedRate truth = truth_at(block.report, block.stage);
  result.claims.push_back(
      {.statement = "The published probability is an upper bound (thesis, Eq. 4-14)",
       .holds = published >= truth.limits.lower,
       .evidence = fmt::format("{:.2g} where {:.2g} of the samples are inside the block", published,
                               truth.rate)});
  result.figures = {
      {.file = "algorithm-4.svg",
       .title = "The published probability, bounds, and the truth",
       .caption = "Left: past walls alone; right: with a block ahead. The truth is simulated; its "
                  "lower limit is wrong with probability 1e-6.",
       .panels = {chart_of(walls), chart_of(block)}}};
  result.remarks = {
      "Algorithm 3 takes a norm over the dimensions instead of the least distance to a face and "
      "leaves the obstacles out, and Eq. 4-4 leaves the noise out of the radius, so its "
      "certificates can be below the truth. Algorithm 4 spends d · m against the radius, which is "
      "right for W1: with a correct distance and radius it is a bound, but a looser one than d² · "
      "m against the radius squared."};
  return result;
}

}  // namespace qsmpc::harness
