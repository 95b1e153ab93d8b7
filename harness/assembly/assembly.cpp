#include "harness/assembly/assembly.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "harness/control/outside_controller.hpp"
#include "harness/errors.hpp"
#include "harness/scenario/known_names.hpp"
#include "harness/scenario/model_dynamics.hpp"
#include "harness/scenario/outside_controllers.hpp"
#include "harness/threads/executor.hpp"
#include "harness/threads/interruption.hpp"

namespace qsmpc::harness {

std::unique_ptr<const models::Dynamics> model_of(const Scenario& scenario) {
  return make_model(scenario.model, scenario.time_step);
}

controller::PredictedMotion of_plant(controller::PredictedMotion motion, const Scenario& scenario,
                                     Eigen::Index period, BeliefOf belief) {
  if (!scenario.model_error) return motion;
  motion.model_error = &*scenario.model_error;
  motion.first_period = period;
  if (period > 0 && belief == BeliefOf::kPrediction) {
    motion.belief_error = &scenario.model_error->of_period(period - 1);
  }
  return motion;
}

controller::PlannerSettings planner_settings(const Scenario& scenario) {
  const Scenario::Controller& controller = scenario.controller;
  const Scenario::Penalty& penalty = controller.penalty;
  controller::PlannerSettings settings;
  settings.horizon = controller.horizon;
  settings.closed_loop = controller.policy == "closed_loop";
  settings.guide = controller.guide == "grid";
  settings.feedback_gain = controller.feedback_gain;
  if (controller.feedback_effort > 0.0) settings.feedback_effort = controller.feedback_effort;
  settings.optimise_gain = controller.optimise_gain;
  settings.solver = controller.solver;
  settings.input_bounding = controller.input_bounding;
  settings.propagator = controller.propagate_noise ? controller.propagator : "noise_free";
  settings.quantiser = controller::quantiser_kind(controller.quantisation.quantiser);
  settings.state_points = controller.quantisation.state;
  settings.noise_points = controller.quantisation.noise;
  settings.compressed_points = controller.quantisation.compressed;
  settings.max_evaluations = controller.max_iterations;
  settings.deadline = controller.deadline;
  settings.run = [run = executor_of(controller.threads)](int count, controller::TaskRef task) {
    check_interrupts();
    run(count, task);
  };
  settings.noise_covariance = scenario.disturbance.covariance;
  settings.cost = {.state = controller.cost.state,
                   .input = controller.cost.input,
                   .terminal = controller.cost.terminal,
                   .target = scenario.target.state,
                   .angles = scenario.target.angles};
  settings.path = scenario.target.course;
  settings.waypoints = scenario.target.route;
  settings.penalty = {.shape = penalty.shape == "thesis" ? controller::PenaltyShape::kThesis
                                                         : controller::PenaltyShape::kSmooth,
                      .box = penalty.box,
                      .obstacle = penalty.obstacle,
                      .length = penalty.length};
  settings.safe_set = scenario.safe_set;
  settings.risk = {.stage = scenario.risk.stage, .plan = scenario.risk.plan};
  settings.risk_reserve = scenario.risk.reserve;
  settings.otherwise = controller::risk_otherwise(scenario.risk.otherwise);
  settings.model_error = scenario.model_error;
  settings.bounds = {.lower = controller.input_lower, .upper = controller.input_upper};
  return settings;
}

controller::ControllerSettings controller_settings(const Scenario& scenario) {
  const Scenario::Controller& controller = scenario.controller;
  controller::ChanceSettings chance = controller.chance;
  const bool answers_to_noise = controller.policy == "disturbance_feedback";
  chance.memory = answers_to_noise ? controller.disturbance_memory : 0;
  return {.problem = planner_settings(scenario),
          .lqr_about = controller.lqr_about == "target" ? controller::LqrAbout::kTarget
                                                        : controller::LqrAbout::kPath,
          .shield = {.of = controller.shield.of,
                     .limit = controller.shield.limit,
                     .stages = controller.shield.stages},
          .chance = chance,
          .mppi = controller.mppi,
          .mission = scenario.risk.mission};
}

std::unique_ptr<controller::Controller> make_controller(const Scenario& scenario,
                                                        const models::Dynamics& dynamics) {
  if (scenario.controller.kind == kObjectController) {
    throw InputError({.key = "controller.kind",
                      .found = std::string(kObjectController) + ", " +
                               outside_controller_name(scenario.controller),
                      .expected = "a controller that the program can create"});
  }
  if (is_outside(scenario.controller)) {
    return std::make_unique<OutsideController>(scenario, dynamics);
  }
  return controller::make_controller(scenario.controller.kind, dynamics,
                                     controller_settings(scenario));
}

controller::DecisionParts decision_parts(const Scenario& scenario) {
  if (is_outside(scenario.controller)) return outside_parts(scenario.controller);
  return controller::controller_entry(scenario.controller.kind)
      .parts(controller_settings(scenario));
}

namespace {

std::string policy_words(const Scenario::Controller& controller) {
  if (controller.policy == "disturbance_feedback") return "disturbance feedback";
  const bool closed = controller.policy == "closed_loop" || controller.kind == "tube";
  return closed ? "closed-loop policy" : "open-loop policy";
}

}  // namespace

std::string controller_words(const Scenario& scenario) {
  const Scenario::Controller& controller = scenario.controller;
  std::string words;
  if (is_outside(controller)) {
    words = controller.kind + ", " + outside_controller_name(controller);
  } else if (controller.kind == "lqr") {
    words = "lqr about the " + controller.lqr_about;
  } else if (is_sampling(controller)) {
    words = fmt::format("{}{}, {} samples", controller.kind == "shield" ? "shield, of " : "",
                        driving_kind(controller), controller.mppi.samples);
  } else {
    if (controller.kind != controller::controllers().front().name) words = controller.kind + ", ";
    if (controller.kind == "shield") words += "of " + controller.shield.of + ", ";
    words += policy_words(controller);
  }
  const int stages = decision_parts(scenario).stages;
  return stages > 0 ? words + ", horizon " + std::to_string(stages) : words;
}

int certified_stages(const controller::DecisionParts& parts) { return std::max(parts.stages, 1); }

}  // namespace qsmpc::harness
