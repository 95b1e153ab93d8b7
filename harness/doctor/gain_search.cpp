#include "harness/doctor/gain_search.hpp"

#include <cmath>
#include <utility>

#include "harness/assembly/assembly.hpp"
#include "harness/mujoco/mujoco_model.hpp"
#include "harness/scenario/plant_mapping_reader.hpp"
#include "models/dynamics/dynamics.hpp"

namespace qsmpc::harness {
namespace {

constexpr int kRounds = 5;
constexpr double kCloseEnough = 0.02;  // of a ratio from 1
constexpr double kNoRatio = 0.01;      // below this, the factor would be a guess

/// The state that an input acts on first, relative to the states' scales; -1 for none.
int first_state(const InputAnswer& answer, const PlantAnswers& all) {
  int first = -1;
  double largest = 0.0;
  for (std::size_t i = 0; i < answer.states.size(); ++i) {
    const StateAnswer& state = answer.states[i];
    if (std::isnan(state.ratio)) continue;
    const double size = std::abs(state.model[0]) / all.scale[static_cast<Eigen::Index>(i)];
    if (size <= largest) continue;
    largest = size;
    first = static_cast<int>(i);
  }
  return first;
}

/// The factor for the gains that cause `answer`; 1 where it is not known.
double factor_of(const InputAnswer& answer, const PlantAnswers& all) {
  const int state = first_state(answer, all);
  if (state < 0) return 1.0;
  const double ratio = answer.states[static_cast<std::size_t>(state)].ratio;
  if (std::abs(ratio) < kNoRatio || std::abs(ratio - 1.0) < kCloseEnough) return 1.0;
  return 1.0 / ratio;
}

/// Scales the goals of the feedback loops that follow `input` or, if it is empty, a constant goal.
/// Returns whether there are any.
bool scale_goals(PlantMapping& mapping, const std::string& input, double factor) {
  bool any = false;
  for (PlantLoop& loop : mapping.loops) {
    auto* feedback = std::get_if<FeedbackLoop>(&loop);
    if (feedback == nullptr || feedback->input != input) continue;
    feedback->goal.gain *= factor;
    any = true;
  }
  return any;
}

/// Clears the responses of feedback loops, so that they are measured. Returns whether any was set.
bool forget_responses(PlantMapping& mapping) {
  bool any = false;
  for (PlantLoop& loop : mapping.loops) {
    auto* feedback = std::get_if<FeedbackLoop>(&loop);
    if (feedback == nullptr || !feedback->response) continue;
    feedback->response.reset();
    any = true;
  }
  return any;
}

/// Returns whether it changed anything.
bool scale_gains(PlantMapping& mapping, const PlantAnswers& answers,
                 const models::SystemDescription& system) {
  bool changed = false;
  for (const InputAnswer& answer : answers.inputs) {
    const double factor = factor_of(answer, answers);
    if (factor == 1.0) continue;
    if (answer.input < 0) {
      for (HoldTerm& hold : mapping.holds) hold.constant.gain *= factor;
      changed = scale_goals(mapping, "", factor) || changed || !mapping.holds.empty();
      continue;
    }
    const std::string& name = system.inputs[static_cast<std::size_t>(answer.input)].name;
    changed = scale_goals(mapping, name, factor) || changed;
    const auto terms = mapping.inputs.find(name);
    if (terms == mapping.inputs.end()) continue;
    for (ControlTerm& term : terms->second) term.gain *= factor;
    changed = changed || !terms->second.empty();
  }
  return changed;
}

}  // namespace

PlantMapping mapping_of(const Scenario& scenario) {
  if (scenario.plant.mapping) return *scenario.plant.mapping;
  const MujocoModelPtr model = load_mujoco_model(scenario.plant.mjcf);
  return own_plant_mapping(
      custom_text(*model, kMappingText), scenario.plant.mjcf,
      {.description = model_of(scenario)->description(), .parameters = scenario.model.parameters});
}

GainSearch search_gains(const Scenario& scenario, const PlantAnswers& answers) {
  const models::SystemDescription system = model_of(scenario)->description();
  GainSearch search{.mapping = mapping_of(scenario), .answers = answers};
  for (int round = 0; round < kRounds; ++round) {
    Scenario next = scenario;
    next.plant.mapping = search.mapping;
    const bool forgot = round == 0 && forget_responses(*next.plant.mapping);
    if (!forgot && !scale_gains(*next.plant.mapping, search.answers, system)) break;
    PlantAnswers found = plant_answers(next);
    if (found.fault) break;
    search.mapping = *std::move(next.plant.mapping);
    search.answers = std::move(found);
    search.changed = true;
  }
  return search;
}

}  // namespace qsmpc::harness
