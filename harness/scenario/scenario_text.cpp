// to_yaml: the writing side of scenario_file.hpp.
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "harness/scenario/model_error_reader.hpp"
#include "harness/scenario/plant_mapping_reader.hpp"
#include "harness/scenario/scenario_file.hpp"
#include "harness/scenario/shipped_files.hpp"
#include "harness/scenario/yaml_text.hpp"

namespace qsmpc::harness {
namespace {

std::string box(const controller::Box& box, const std::vector<models::Coordinate>& states) {
  std::string out = "{";
  for (Eigen::Index i = 0; i < box.lower.size(); ++i) {
    out +=
        fmt::format("{}{}: [{}, {}]", i == 0 ? "" : ", ", states[static_cast<std::size_t>(i)].name,
                    yaml_number(box.lower[i]), yaml_number(box.upper[i]));
  }
  return out + "}";
}

std::string model_text(const Scenario& scenario) {
  std::string out = "model: {system: " + scenario.model.system;
  for (const auto& [name, value] : scenario.model.parameters) {
    out += fmt::format(", {}: {}", name, yaml_number(value));
  }
  return out + "}\n";
}

std::string disturbance_text(const Scenario::Disturbance& disturbance) {
  return fmt::format(
      "disturbance:\n  covariance: {}\n  sensor: {}\n  kind: {}\n  friction: {}\n  mass: {}\n  "
      "wheelbase: {}\n",
      yaml_square(disturbance.covariance), yaml_square(disturbance.sensor), disturbance.kind,
      yaml_number(disturbance.friction), yaml_number(disturbance.mass),
      yaml_number(disturbance.wheelbase));
}

std::string plant_text(const Scenario::Plant& plant) {
  std::string out =
      fmt::format("plant: {{kind: {}, mjcf: {}", plant.kind, quoted_yaml(mjcf_name(plant.mjcf)));
  if (plant.time_step) out += ", time_step: " + yaml_number(*plant.time_step);
  if (plant.mapping) out += ", " + plant_mapping_text(*plant.mapping);
  return out + "}\n";
}

std::string safe_set_text(const controller::SafeSet& safe_set,
                          const std::vector<models::Coordinate>& states) {
  std::string out = fmt::format("safe_set:\n  bounds: {}\n", box(safe_set.bounds, states));
  if (safe_set.obstacles.empty()) return out + "  obstacles: []\n";
  out += "  obstacles:\n";
  for (const controller::Box& obstacle : safe_set.obstacles) {
    out += fmt::format("    - {}\n", box(obstacle, states));
  }
  return out;
}

std::string target_text(const Scenario::Target& target,
                        const std::vector<models::Coordinate>& states) {
  std::vector<std::string> angles;
  angles.reserve(target.angles.size());
  for (const int index : target.angles) {
    angles.push_back(states[static_cast<std::size_t>(index)].name);
  }
  return fmt::format("target:\n  state: {}\n  radius: {}\n  angles: [{}]\n",
                     yaml_list(target.state), yaml_number(target.radius), fmt::join(angles, ", "));
}

std::string input_bounds(const Scenario::Controller& controller,
                         const std::vector<models::Coordinate>& inputs) {
  return box({controller.input_lower, controller.input_upper}, inputs);
}

std::string controller_text(const Scenario::Controller& controller,
                            const std::vector<models::Coordinate>& inputs) {
  std::string out = fmt::format("controller:\n  kind: {}\n", controller.kind);
  if (controller.kind == "lqr") out += fmt::format("  lqr: {{about: {}}}\n", controller.lqr_about);
  out += fmt::format("  horizon: {}\n  policy: {}\n", controller.horizon, controller.policy);
  if (controller.feedback_gain) {
    out += fmt::format("  feedback_gain: {}\n", yaml_rows(*controller.feedback_gain));
  }
  const Scenario::Quantisation& points = controller.quantisation;
  const Scenario::Penalty& penalty = controller.penalty;
  out += fmt::format("  optimise_gain: {}\n  solver: {}\n  input_bounding: {}\n",
                     controller.optimise_gain, controller.solver, controller.input_bounding);
  out += fmt::format("  quantisation: {{state: {}, noise: {}, compressed: {}, quantiser: {}}}\n",
                     points.state, points.noise, points.compressed, points.quantiser);
  out += fmt::format("  propagate_noise: {}\n  propagator: {}\n", controller.propagate_noise,
                     controller.propagator);
  out += fmt::format("  cost:\n    state: {}\n    input: {}\n    terminal: {}\n",
                     yaml_square(controller.cost.state), yaml_square(controller.cost.input),
                     yaml_square(controller.cost.terminal));
  out += fmt::format("  penalty: {{shape: {}, box: {}, obstacle: {}, length: {}}}\n", penalty.shape,
                     yaml_number(penalty.box), yaml_number(penalty.obstacle),
                     yaml_number(penalty.length));
  out += fmt::format("  input_bounds: {}\n", input_bounds(controller, inputs));
  if (std::isfinite(controller.deadline)) {
    out += fmt::format("  deadline: {}\n", yaml_number(controller.deadline));
  }
  return out + fmt::format("  max_iterations: {}\n  threads: {}\n", controller.max_iterations,
                           controller.threads);
}

}  // namespace

std::string to_yaml(const Scenario& scenario) {
  const auto dynamics =
      models::make_dynamics(scenario.model.system, scenario.model.parameters, scenario.time_step);
  const models::SystemDescription& system = dynamics->description();
  const Scenario::Video& video = scenario.video;
  std::string out;
  out += fmt::format("name: {}\ndescription: {}\nseed: {}\n", quoted_yaml(scenario.name),
                     quoted_yaml(scenario.description), scenario.seed);
  out += model_text(scenario);
  out += plant_text(scenario.plant);
  out += fmt::format("time_step: {}\n", yaml_number(scenario.time_step));
  out += fmt::format("initial_state:\n  mean: {}\n  covariance: {}\n",
                     yaml_list(scenario.initial_state.mean),
                     yaml_square(scenario.initial_state.covariance));
  out += disturbance_text(scenario.disturbance);
  if (scenario.model_error) out += "model_error:\n" + model_error_text(*scenario.model_error, "  ");
  out += safe_set_text(scenario.safe_set, system.states);
  out += target_text(scenario.target, system.states);
  out += fmt::format("estimator: {{kind: {}}}\n", scenario.estimator.kind);
  out += controller_text(scenario.controller, system.inputs);
  out += fmt::format("limit: {{steps: {}, stop_when_unsafe: {}}}\n", scenario.step_limit,
                     scenario.stop_when_unsafe);
  out += fmt::format("video: {{camera: {}, size: {}x{}, fps: {}, overlays: [{}]}}\n", video.camera,
                     video.width, video.height, video.fps, fmt::join(video.overlays, ", "));
  return out;
}

}  // namespace qsmpc::harness
