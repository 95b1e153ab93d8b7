#include "harness/doctor/diagnosis.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <utility>

#include <fmt/format.h>

#include "harness/assembly/assembly.hpp"
#include "harness/text/number_format.hpp"

namespace qsmpc::harness {
namespace {

// Limits of the ratio: wrong where the discrepancy matters, and always wrong.
constexpr double kSmall = 0.75;
constexpr double kLarge = 1.0 / 0.75;
constexpr double kTooSmall = 0.5;
constexpr double kTooLarge = 2.0;
constexpr double kNothing = 0.05;  // ratio
constexpr double kLatePeriods = 1.5;
constexpr double kForeseen = 0.25;           // of the state's scale
constexpr double kMismatchDeviations = 3.0;  // of the planned noise
constexpr double kTipped = 1.0;              // rad; slopes and soft springs tilt less

constexpr std::array kVerdictNames{"ok", "none", "sign", "size", "late", "unforeseen", "mismatch"};

double planned_deviation(const Scenario& scenario, std::size_t state) {
  const auto i = static_cast<Eigen::Index>(state);
  return std::sqrt(scenario.disturbance.covariance(i, i));
}

std::string number(double value, const models::Coordinate& coordinate) {
  return format_short(value) + (coordinate.unit.empty() ? "" : " " + coordinate.unit);
}

/// "yaw_rate ±0.1 rad/s changes heading", or "without an input, x changes".
std::string subject(const InputAnswer& answer, const models::SystemDescription& system,
                    std::size_t state) {
  const std::string& name = system.states[state].name;
  if (answer.input < 0) return fmt::format("without an input, {} changes", name);
  const models::Coordinate& input = system.inputs[static_cast<std::size_t>(answer.input)];
  return fmt::format("{} held at ±{} changes {}", input.name, number(answer.amplitude, input),
                     name);
}

std::string warning(AnswerVerdict verdict, const Scenario& scenario, const PlantAnswers& answers,
                    const InputAnswer& answer, std::size_t state,
                    const models::SystemDescription& system) {
  const StateAnswer& found = answer.states[state];
  const models::Coordinate& coordinate = system.states[state];
  const Eigen::Index last = found.model.size() - 1;
  const std::string sizes =
      fmt::format("{} by {} in {} s, and by {} in the model", subject(answer, system, state),
                  number(found.plant[last], coordinate),
                  format_short(answers.period * static_cast<double>(answers.periods)),
                  number(found.model[last], coordinate));
  switch (verdict) {
    case AnswerVerdict::kSign:
      return sizes + ": the wrong sign";
    case AnswerVerdict::kNone:
      return sizes + ": the plant hardly responds";
    case AnswerVerdict::kSize:
      return fmt::format("{}: {} times the model's", sizes, format_short(found.ratio));
    case AnswerVerdict::kLate:
      return fmt::format("{}: {} s late ({} periods)", sizes, format_short(found.delay),
                         format_short(found.delay / answers.period));
    case AnswerVerdict::kMismatch:
    case AnswerVerdict::kUnforeseen:
    case AnswerVerdict::kAsModel:
      break;
  }
  return fmt::format("{}: they differ by up to {} per period{}, but the planned noise is {}", sizes,
                     number(found.discrepancy, coordinate),
                     answer.input < 0 ? "" : " at full input",
                     number(planned_deviation(scenario, state), coordinate));
}

/// A warning that the vehicle has tipped over, which explains all other problems.
std::optional<std::string> tipping_warning(const PlantAnswers& answers) {
  const auto degrees = [](double angle) { return std::round(angle * 180.0 / std::numbers::pi); };
  if (answers.tilt_at_start > kTipped) {
    return fmt::format(
        "the vehicle tips over while settling: at the start of a drive it is tilted by {}°",
        degrees(answers.tilt_at_start));
  }
  if (answers.tilt > kTipped) {
    return fmt::format(
        "the vehicle tips over: after {} periods of small inputs it is tilted by {}°",
        answers.periods, degrees(answers.tilt));
  }
  return std::nullopt;
}

}  // namespace

const char* verdict_name(AnswerVerdict verdict) {
  return kVerdictNames.at(static_cast<std::size_t>(verdict));
}

AnswerVerdict verdict_of(const Scenario& scenario, const PlantAnswers& answers,
                         const InputAnswer& answer, std::size_t state) {
  const StateAnswer& found = answer.states[state];
  const double noise = planned_deviation(scenario, state);
  const double scale = answers.scale[static_cast<Eigen::Index>(state)];
  const bool matters = noise == 0.0 || found.discrepancy > noise;
  if (std::isnan(found.ratio)) {
    const bool moves = found.plant.cwiseAbs().maxCoeff() > kForeseen * scale && scale > 0.0;
    return matters && moves ? AnswerVerdict::kUnforeseen : AnswerVerdict::kAsModel;
  }
  if (matters || found.model.cwiseAbs().maxCoeff() > kForeseen * scale) {
    if (std::abs(found.ratio) < kNothing) return AnswerVerdict::kNone;
    if (found.ratio < 0.0) return AnswerVerdict::kSign;
    if (found.ratio < kTooSmall || found.ratio > kTooLarge) return AnswerVerdict::kSize;
  }
  if (!matters) return AnswerVerdict::kAsModel;
  if (found.ratio < kSmall || found.ratio > kLarge) return AnswerVerdict::kSize;
  if (found.delay > kLatePeriods * answers.period) return AnswerVerdict::kLate;
  const bool is_apart = noise > 0.0 && found.discrepancy > kMismatchDeviations * noise;
  return is_apart ? AnswerVerdict::kMismatch : AnswerVerdict::kAsModel;
}

std::vector<std::string> answer_warnings(const Scenario& scenario, const PlantAnswers& answers) {
  if (answers.fault) {
    return {fmt::format("the plant fails within {} periods of small inputs: {}", answers.periods,
                        *answers.fault)};
  }
  const models::SystemDescription system = model_of(scenario)->description();
  std::vector<std::string> warnings;
  if (auto tipping = tipping_warning(answers)) warnings.push_back(std::move(*tipping));
  for (const InputAnswer& answer : answers.inputs) {
    for (std::size_t i = 0; i < answer.states.size(); ++i) {
      const AnswerVerdict verdict = verdict_of(scenario, answers, answer, i);
      if (verdict == AnswerVerdict::kAsModel) continue;
      warnings.push_back(warning(verdict, scenario, answers, answer, i, system));
    }
  }
  return warnings;
}

std::vector<std::string> plant_warnings(const Scenario& scenario) {
  if (scenario.plant.kind == "analytic") return {};
  return answer_warnings(scenario, plant_answers(scenario));
}

}  // namespace qsmpc::harness
