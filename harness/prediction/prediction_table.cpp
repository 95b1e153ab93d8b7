#include "harness/prediction/prediction_table.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include <fmt/format.h>

#include "harness/scenario/certificate_scope.hpp"
#include "harness/text/number_format.hpp"
#include "harness/text/printable.hpp"

namespace qsmpc::harness {
namespace {

// Widths of columns in characters; all columns together take at most 78 of a terminal's 80.
constexpr std::size_t kStageWidth = 5;
constexpr std::size_t kStateWidth = 10;
constexpr std::size_t kNameLimit = 8;  // of a state's name; a longer one is cut and marked

/// Two states represent all of them: the position in the plane, else the first two.
std::vector<int> shown_states(const models::SystemDescription& system) {
  if (system.position_x >= 0 && system.position_y >= 0) {
    return {system.position_x, system.position_y};
  }
  return system.states.size() > 1 ? std::vector<int>{0, 1} : std::vector<int>{0};
}

/// Values below this are rounding errors of zero, in any unit of the states.
constexpr double kRoundedToZero = 1e-9;

/// Three decimals if that shows enough and is not too long; at most 9 characters.
std::string number(double value) {
  const double shown = std::abs(value) < kRoundedToZero ? 0.0 : value;
  return is_plain_in_table(shown) ? fmt::format("{:.3f}", shown) : fmt::format("{:.3g}", shown);
}

std::string probability(double value) { return fmt::format("{:.2e}", value); }

/// The columns after the states, of the same widths for header, stages and total.
std::string tail(const std::string& distance, const std::string& bound, const std::string& kind,
                 const std::string& thesis) {
  return fmt::format("{:>9}{:>12}  {:<3}{:>9}", distance, bound, kind, thesis);
}

std::string simulated_columns(const std::string& rate, const std::string& upper) {
  return fmt::format("{:>9}{:>9}", rate, upper);
}

std::string simulated_columns(const UnsafeCounts& counts, std::int64_t events) {
  const SimulatedRate simulated = simulated_rate(events, counts.samples);
  return simulated_columns(probability(simulated.rate), probability(simulated.limits.upper));
}

std::string head(const PredictionReport& report, const models::SystemDescription& system,
                 const std::vector<int>& states) {
  std::string names = fmt::format("{:>{}}", "stage", kStageWidth);
  std::string units(kStageWidth, ' ');
  for (const int state : states) {
    const models::Coordinate& shown = system.states[static_cast<std::size_t>(state)];
    names += fmt::format("{:>{}}", printable(shown.name, kNameLimit), kStateWidth);
    units += fmt::format("{:>{}}", shown.unit, kStateWidth);
  }
  const bool holds = why_no_bound(report.scenario).empty();
  names += tail("W2 <=", holds ? "P(unsafe)<=" : "NO BOUND", "by", "thesis*");
  if (report.monte_carlo) names += simulated_columns("rate", "rate <=");
  return names + "\n" + units + "\n";
}

std::string stage_row(const PredictionReport& report, std::size_t stage,
                      const std::vector<int>& states) {
  const Eigen::VectorXd mean = controller::mean_of(report.prediction.stages[stage]);
  const controller::StageCertificate& certificate = report.certificates[stage - 1];
  std::string text = fmt::format("{:>{}}", stage, kStageWidth);
  for (const int state : states) text += fmt::format("{:>{}}", number(mean[state]), kStateWidth);
  text += tail(number(report.budgets[stage].total), probability(certificate.value),
               certificate.kind, probability(certificate.of("thesis")));
  if (report.monte_carlo) {
    text += simulated_columns(*report.monte_carlo, report.monte_carlo->stages[stage - 1]);
  }
  return text + "\n";
}

/// Whether the horizon's bound is tighter than the sum of the stages' certificates.
bool counts_entries(const PredictionReport& report) {
  double sum = 0.0;
  for (const controller::StageCertificate& stage : report.certificates) sum += stage.value;
  return report.horizon_bound < std::min(1.0, sum);
}

std::string total_row(const PredictionReport& report, std::size_t states) {
  std::string text = fmt::format("{:<{}}", "  any", kStageWidth + kStateWidth * states);
  text += tail("", probability(report.horizon_bound), counts_entries(report) ? "1st" : "sum", "-");
  if (report.monte_carlo) {
    text += simulated_columns(*report.monte_carlo, report.monte_carlo->any_stage);
  }
  return text + "\n";
}

/// States what the certificates refer to, if they hold at all.
std::string scope_note(const Scenario& scenario) {
  if (!why_no_bound(scenario).empty()) {
    return "NO BOUND: with measurement noise (disturbance.sensor) the feedback acts on\n"
           "what is seen. The numbers hold for a policy that sees the state itself.\n";
  }
  return scenario.model_error
             ? "P(unsafe)<= holds for plants within model_error under this plan as planned:\n"
               "replanning on the way is not covered.\n"
             : "P(unsafe)<= holds for the model under this plan as planned: a plant that\n"
               "differs from it, and replanning on the way, are not covered.\n";
}

}  // namespace

std::string prediction_table(const PredictionReport& report) {
  const std::vector<int> states = shown_states(report.system);
  std::string origin = report.inputs_given ? "given" : "planned";
  if (!report.solver_status.empty()) origin += " (" + report.solver_status + ")";
  std::string text =
      fmt::format("{}: {} stages of {:.3g} s, inputs {}", printable(report.scenario.name),
                  report.certificates.size(), report.scenario.time_step, origin);
  if (std::isfinite(report.cost.total())) {
    text += fmt::format(", expected cost {:.5g}", report.cost.total());
  }
  text += "\n";
  text += head(report, report.system, states);
  for (std::size_t stage = 1; stage < report.prediction.stages.size(); ++stage) {
    text += stage_row(report, stage, states);
  }
  text += total_row(report, states.size());
  text += scope_note(report.scenario);
  if (counts_entries(report)) {
    text += "1st: a state that stays unsafe is counted once, so less than the stages' sum\n";
  }
  text += "* the published algorithms' value: NOT a bound\n";
  if (report.monte_carlo) {
    text += fmt::format("rate: of {} simulated paths; rate <=: its limit, wrong once in {:.0e}\n",
                        report.monte_carlo->samples, 1.0 / kRateTail);
  }
  return text;
}

}  // namespace qsmpc::harness
