#include "harness/mismatch/comparison_table.hpp"

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

constexpr std::size_t kNameWidth = 20;   // of plant and row names
constexpr std::size_t kStateWidth = 12;  // of columns by state; six fit a line
constexpr std::size_t kStageWidth = 5;
constexpr std::size_t kStageStateWidth = 9;
constexpr std::size_t kNameLimit = 8;  // of a state among stages; longer names are cut and marked
constexpr double kSurprising = 0.01;   // p-values below it are marked

std::string plant_name(const std::string& name) {
  return fmt::format("  {:<{}}", printable(name, kNameWidth - 3), kNameWidth - 2);
}

/// Three digits, at most 9 characters.
std::string number(double value) {
  if (std::isnan(value)) return "-";
  return is_plain_in_table(value) ? fmt::format("{:.3f}", value) : fmt::format("{:.2e}", value);
}

std::string by_state(const std::string& name, const Eigen::VectorXd& values,
                     bool with_norm = false) {
  std::string row = fmt::format("  {:<{}}", name, kNameWidth - 2);
  for (const double value : values) row += fmt::format("{:>{}}", number(value), kStateWidth);
  if (with_norm) row += fmt::format("{:>{}}", number(values.norm()), kStateWidth);
  return row + "\n";
}

/// The heading of the certificates of the drives. Along the plan the policy observes the state, so
/// certificates are always bounds there.
const char* certified_head(const Comparison& comparison) {
  return why_no_bound(comparison.scenario).empty() ? "certified" : "NO BOUND";
}

std::string drives_section(const Comparison& comparison) {
  std::string text = fmt::format(
      "\nWhat became of the drives\n  {:<{}}{:>9}{:>12}{:>12}{:>14}{:>12}{:>12}\n", "plant",
      kNameWidth - 2, "drives", "reached", "collision", "left bounds", "timeout", "fault");
  for (const PlantComparison& plant : comparison.plants) {
    const ClosedLoop& loop = plant.closed_loop;
    text += plant_name(plant.name);
    text += fmt::format("{:>9}{:>12}{:>12}{:>14}{:>12}{:>12}\n", loop.episodes,
                        loop.count(Outcome::kReached), loop.count(Outcome::kCollision),
                        loop.count(Outcome::kLeftBounds), loop.count(Outcome::kTimeout),
                        loop.count(Outcome::kFault));
  }
  return text;
}

std::string closed_loop_section(const Comparison& comparison) {
  std::string text = fmt::format("\nClosed loop\n  {:<{}}{:>9}{:>16}{:>22}{:>14}\n", "plant",
                                 kNameWidth - 2, "unsafe", "99 % interval", "cost", "clearance");
  for (const PlantComparison& plant : comparison.plants) {
    const ClosedLoop& loop = plant.closed_loop;
    text += plant_name(plant.name);
    text += fmt::format(
        "{:>9}{:>16}{:>22}{:>14}\n", fmt::format("{}/{}", loop.unsafe, loop.episodes),
        fmt::format("[{:.3f}, {:.3f}]", loop.unsafe_limits.lower, loop.unsafe_limits.upper),
        std::isnan(loop.cost_deviation)
            ? fmt::format("{:.5g}", loop.cost)
            : fmt::format("{:.5g} +- {:.2g}", loop.cost, loop.cost_deviation),
        number(loop.min_clearance));
  }
  return text;
}

/// Names and units of `states` in columns of `width`, after `left` characters; `right` is appended
/// to the line of names.
std::string state_head(const std::vector<models::Coordinate>& states, std::size_t left,
                       std::size_t width, const std::string& right = "") {
  std::string names;
  std::string units;
  for (const models::Coordinate& state : states) {
    names += fmt::format("{:>{}}", printable(state.name, kNameLimit), width);
    units += fmt::format("{:>{}}", state.unit, width);
  }
  return fmt::format("{:<{}}{}{}\n{:<{}}{}\n", "", left, names, right, "", left, units);
}

std::string one_step_section(const Comparison& comparison,
                             const models::SystemDescription& system) {
  std::string text = "\nOne period: what the plant adds to the model and the disturbance\n" +
                     state_head(system.states, kNameWidth, kStateWidth,
                                fmt::format("{:>{}}", "norm", kStateWidth));
  text += by_state("disturbance, rms",
                   comparison.scenario.disturbance.covariance.diagonal().cwiseSqrt(), true);
  for (const PlantComparison& plant : comparison.plants) {
    const ResidualStatistics& one_step = plant.one_step;
    const bool exact = (one_step.rmse.array() <= one_step.rounding.array()).all();
    text += fmt::format("  {}{}\n", printable(plant.name, 60),
                        exact ? ": matches the model except for rounding" : "");
    text += by_state("  rms", one_step.rmse, true);
    if (exact) continue;
    text += by_state("  mean", one_step.mean);
    text += by_state("  +- (one sigma)", one_step.mean_deviation);
    text += by_state("  lag-1 correlation", one_step.whiteness.lag1);
    text += by_state(fmt::format("  p (white, {} lags)", one_step.whiteness.lags),
                     one_step.whiteness.p_value);
  }
  return text;
}

/// Up to three representative states: the pose in the plane, else the first three.
std::vector<int> shown_states(const models::SystemDescription& system) {
  std::vector<int> shown;
  for (const int state : {system.position_x, system.position_y, system.heading}) {
    if (state >= 0) shown.push_back(state);
  }
  const int most = std::min(3, static_cast<int>(system.states.size()));
  for (int state = 0; shown.empty() && state < most; ++state) shown.push_back(state);
  if (shown.size() == 1 && most > 1) shown = {0, 1};
  return shown;
}

std::string horizon_head(const models::SystemDescription& system, const std::vector<int>& states,
                         const char* certified) {
  std::vector<models::Coordinate> shown;
  shown.reserve(states.size());
  for (const int state : states) shown.push_back(system.states[static_cast<std::size_t>(state)]);
  std::string head = state_head(shown, kStageWidth, kStageStateWidth,
                                fmt::format("{:>10}{:>9}{:>16}{:>10}{:>19}", "to model", "W2",
                                            "floor", certified, "observed (99 %)"));
  return head.replace(0, kStageWidth, fmt::format("{:>{}}", "stage", kStageWidth));
}

std::string stage_row(const Comparison& comparison, const HorizonStage& stage,
                      const std::vector<int>& states) {
  const auto k = static_cast<std::size_t>(stage.stage);
  std::string row = fmt::format("{:>{}}", stage.stage, kStageWidth);
  for (const int state : states) {
    row += fmt::format("{:>{}}", number(stage.divergence_rmse[state]), kStageStateWidth);
  }
  const W2Floor& floor = comparison.floors[k];
  row += fmt::format(
      "{:>10}{:>9}{:>16}{:>10.1e}{:>19}\n", number(stage.w2_to_model()), number(stage.w2),
      fmt::format("{} +- {:.3f}", number(floor.mean), floor.deviation),
      comparison.in_force()[k - 1].value,
      fmt::format("[{:.1e}, {:.1e}]", stage.unsafe_limits.lower, stage.unsafe_limits.upper));
  return row;
}

std::string horizon_section(const Comparison& comparison, const models::SystemDescription& system) {
  const std::vector<int> states = shown_states(system);
  std::string text = fmt::format(
      "\nAlong the plan from the initial belief: divergence from the model (rms, by state), {} "
      "paths\n",
      comparison.paths);
  for (const PlantComparison& plant : comparison.plants) {
    text += fmt::format(
        "  {}{}\n", printable(plant.name, 60),
        plant.paths.faults > 0
            ? fmt::format(": {} paths on which it broke or was refused", plant.paths.faults)
            : "");
    text += horizon_head(system, states, "certified");
    for (const HorizonStage& stage : plant.horizon) {
      text += stage_row(comparison, stage, states);
    }
  }
  return text;
}

std::string certificate_section(const Comparison& comparison) {
  std::string text = fmt::format(
      "\nCertificates {} the scenario's model error, against the plant\n"
      "  {:<{}}{:>16}{:>16}{:>15}{:>10}{:>14}\n",
      comparison.with_error ? "with" : "without", "plant", kNameWidth - 2, "stages exceeded",
      "unsafe periods", certified_head(comparison), "p", "x real time");
  for (const PlantComparison& plant : comparison.plants) {
    const ClosedLoop& loop = plant.closed_loop;
    text += plant_name(plant.name);
    text += fmt::format(
        "{:>16}{:>16}{:>15}{:>10}{:>14.3g}\n",
        fmt::format("{} of {}", plant.exceeded_stages.size(), plant.horizon.size()),
        fmt::format("{} of {}", loop.unsafe_periods, loop.periods),
        fmt::format("{:.2g}", loop.certified_periods),
        fmt::format("{:.2g}{}", loop.p_value, loop.p_value < kSurprising ? " !" : ""), plant.speed);
  }
  return text;
}

std::string scope_note(const Comparison& comparison) {
  if (why_no_bound(comparison.scenario).empty()) return {};
  return "NO BOUND: with measurement noise (disturbance.sensor) the feedback of the drives acts "
         "on\n"
         "what is seen, which certificates do not cover. Along the plan the policy sees the "
         "state:\n"
         "certificates there are bounds.\n";
}

}  // namespace

std::string comparison_table(const Comparison& comparison) {
  const models::SystemDescription& system = comparison.system;
  return fmt::format("{}: plants compared with the model {}, seed {}\n",
                     printable(comparison.scenario.name), system.name, comparison.scenario.seed) +
         drives_section(comparison) + closed_loop_section(comparison) +
         one_step_section(comparison, system) + horizon_section(comparison, system) +
         certificate_section(comparison) +
         "to model: upper bound of W2 between plant and model, from the same random numbers.\n"
         "W2: between the predicted particles and the plant's paths.\n"
         "floor: W2 where the plant is the model, because there are few particles and paths.\n"
         "stages exceeded: the observed rate is above the certificate (99.5 % confidence each).\n"
         "p: small where more periods end unsafe than certified.\n" +
         scope_note(comparison);
}

}  // namespace qsmpc::harness
