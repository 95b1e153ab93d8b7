#include "harness/scenario/model_dynamics.hpp"

#include "harness/scenario/dynamics_library.hpp"

namespace qsmpc::harness {

std::unique_ptr<const models::Dynamics> make_model(const Scenario::Model& model, double time_step) {
  if (!model.own) return models::make_dynamics(model.system, model.parameters, time_step);
  models::EquationSystem system = *model.own;
  for (auto& parameter : system.parameters) {
    const auto given = model.parameters.find(parameter.name);
    if (given != model.parameters.end()) parameter.value = given->second;
  }
  if (model.library.empty()) return models::make_equation_dynamics(system, time_step);
  return load_dynamics_library(model.library)->make(system, time_step);
}

models::SystemDescription system_of(const Scenario& scenario) {
  const Scenario::Model& model = scenario.model;
  if (model.own) return models::description_of(*model.own);
  return models::make_dynamics(model.system, model.parameters, scenario.time_step)->description();
}

}  // namespace qsmpc::harness
