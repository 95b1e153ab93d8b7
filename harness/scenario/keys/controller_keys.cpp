// The keys of the controller.
#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "controller/control/controller.hpp"
#include "controller/planning/solvers/ocp_solver.hpp"
#include "harness/scenario/keys/scenario_key.hpp"
#include "harness/scenario/known_names.hpp"
#include "harness/scenario/outside_controllers.hpp"
#include "harness/scenario/section_values.hpp"
#include "harness/scenario/value_checks.hpp"
#include "harness/scenario/yaml_text.hpp"

namespace qsmpc::harness {
namespace {

constexpr WholeValue kHorizonRange{1, kMostStages};
constexpr WholeValue kIterationsRange{1, 100'000};
constexpr WholeValue kThreadsRange{1, 256};
// s; the maximum is well within a clock's range.
constexpr NumberRange kDeadlineRange{.least = 0.0, .most = 1e6, .above_least = true};

/// A key without effect under the other settings may still hold its default, which every resolved
/// scenario contains.
const Scenario::Controller& defaults() {
  static const Scenario::Controller controller;
  return controller;
}

/// Recorded scenarios may name a controller that only a calling program can supply.
void check_kind(const ScenarioReading& reading, Section& section) {
  if (!reading.lookup.must_exist || reading.scenario.controller.kind != kObjectController) return;
  section.note("kind",
               "another controller: an object can only be passed by a program, in Python as "
               "qsmpc.run(scenario, controller=…)");
}

void check_lqr_about(const ScenarioReading& reading, Section& section) {
  const Scenario::Controller& controller = reading.scenario.controller;
  if (driving_kind(controller) != "lqr" && controller.lqr_about != defaults().lqr_about) {
    section.note("about", defaults().lqr_about + ", or controller.kind: lqr");
  }
}

/// The guide's search needs the plane of position, within bounds.
void check_guide(const ScenarioReading& reading, Section& section) {
  const Scenario::Controller& controller = reading.scenario.controller;
  if (controller.guide == defaults().guide) return;
  const std::vector<controller::ControllerEntry>& known = controller::controllers();
  const std::string& kind = driving_kind(controller);
  const bool takes_it = std::any_of(known.begin(), known.end(), [&](const auto& entry) {
    return entry.name == kind && entry.takes_guide;
  });
  std::string guided;
  for (const controller::ControllerEntry& entry : known) {
    if (entry.takes_guide) guided += (guided.empty() ? "" : ", ") + entry.name;
  }
  if (!takes_it) section.note("guide", "none, or a controller that takes one: " + guided);
  const models::SystemDescription& system = reading.system();
  const controller::Box& bounds = reading.scenario.safe_set.bounds;
  for (const int axis : {system.position_x, system.position_y}) {
    if (axis < 0) {
      section.note("guide", "none: " + system.name + " has no position in the plane");
      return;
    }
    const Eigen::Index i = axis;
    if (i < bounds.lower.size() &&
        !(std::isfinite(bounds.lower[i]) && std::isfinite(bounds.upper[i]))) {
      section.note("guide", "none, or finite safe_set.bounds of " +
                                system.states[static_cast<std::size_t>(i)].name);
    }
  }
}

void check_optimise_gain(const ScenarioReading& reading, Section& section) {
  const Scenario::Controller& controller = reading.scenario.controller;
  if (controller.optimise_gain && controller.policy != "closed_loop") {
    section.note("optimise_gain", "false, or controller.policy: closed_loop");
  }
}

void check_input_bounding(const ScenarioReading& reading, Section& section) {
  const Scenario::Controller& controller = reading.scenario.controller;
  if (!controller::solver_entry(controller.solver).chooses_bounding &&
      controller.input_bounding != defaults().input_bounding) {
    section.note("input_bounding", defaults().input_bounding + ", or controller.solver: lbfgs");
  }
}

/// A weight of the penalties. Its default is 0 where risk limits are kept instead.
void read_weight(ScenarioReading& reading, Section& section, const KeyDescription& about,
                 double& weight) {
  const std::vector<controller::ControllerEntry>& known = controller::controllers();
  const auto kind = std::find_if(known.begin(), known.end(), [&](const auto& entry) {
    return entry.name == reading.scenario.controller.kind;
  });
  if (reading.scenario.risk.any() && kind != known.end() && kind->keeps_limits) weight = 0.0;
  weight = section.number(about.name, weight, kNotNegative);
}

void read_gain(ScenarioReading& reading, Section& section, const KeyDescription& about) {
  reading.scenario.controller.feedback_gain = section.matrix(
      about.name, std::ssize(reading.system().inputs), std::ssize(reading.system().states));
}

std::optional<std::string> gain_text(const Scenario& scenario,
                                     const models::SystemDescription& /*system*/) {
  if (!scenario.controller.feedback_gain) return std::nullopt;
  return yaml_rows(*scenario.controller.feedback_gain);
}

void read_terminal_cost(ScenarioReading& reading, Section& section, const KeyDescription& about) {
  Scenario::Cost& cost = reading.scenario.controller.cost;
  cost.terminal = semidefinite(section, about.name, cost.state);
}

void read_input_bounds(ScenarioReading& reading, Section& section, const KeyDescription& about) {
  const models::SystemDescription& system = reading.system();
  Section bounds = section.section(about.name);
  const controller::Box box =
      read_intervals(
          bounds, system.inputs,
          {.fallback = {.lower = system.input_lower, .upper = system.input_upper}, .finite = true})
          .box;
  reading.scenario.controller.input_lower = box.lower;
  reading.scenario.controller.input_upper = box.upper;
}

/// Algorithm 2 of the thesis is defined for boxes only.
void check_penalty_shape(const ScenarioReading& reading, Section& section) {
  if (reading.scenario.controller.penalty.shape != "thesis") return;
  const std::vector<controller::Obstacle>& obstacles = reading.scenario.safe_set.obstacles;
  const auto shape = std::find_if(obstacles.begin(), obstacles.end(),
                                  [](const auto& obstacle) { return obstacle.box() == nullptr; });
  if (shape == obstacles.end()) return;
  section.note("shape", fmt::format("smooth, because safe_set.obstacles.{} is not a box of states",
                                    shape - obstacles.begin()));
}

std::vector<ScenarioKey> kind_keys() {
  return {{.about = {.name = "kind",
                     .values = {NameValue{controller_names()}},
                     .words = "the controller, a name from `qsmpc list controllers`",
                     .see = "[below](#controllers)"},
           .member = [](Scenario& scenario) -> std::string& { return scenario.controller.kind; },
           .check = check_kind},
          {.about = {.name = "lqr"},
           .is_written =
               [](const Scenario& scenario) { return driving_kind(scenario.controller) == "lqr"; },
           .keys = {{.about = {.name = "about",
                               .values = {NameValue{lqr_about_names()}},
                               .words = "what `lqr` linearises about: {names}"},
                     .member = [](Scenario& scenario) -> std::string& {
                       return scenario.controller.lqr_about;
                     },
                     .check = check_lqr_about}},
           .layout = SectionLayout::kFlow}};
}

std::vector<ScenarioKey> plan_keys() {
  return {
      {.about = {.name = "horizon",
                 .values = {kHorizonRange},
                 .words = "number of steps planned ahead"},
       .member = [](Scenario& scenario) -> int& { return scenario.controller.horizon; }},
      {.about = {.name = "policy", .values = {NameValue{policy_names()}}, .words = "{names}"},
       .member = [](Scenario& scenario) -> std::string& { return scenario.controller.policy; },
       .check = check_policy},
      {.about = {.name = "guide",
                 .values = {NameValue{guide_names()}},
                 .words = "what plans aim at: the target (`none`), or the farthest point in sight "
                          "on the cheapest way round obstacles (`grid`)",
                 .see = "[below](#guide)"},
       .member = [](Scenario& scenario) -> std::string& { return scenario.controller.guide; },
       .check = check_guide,
       .is_written = [](const Scenario& scenario) { return scenario.controller.guide != "none"; }},
      {.about = {.name = "feedback_gain",
                 .values = {MatrixValue{.rows = Dimension::kInputs, .cols = Dimension::kStates}},
                 .words = "*m* × *n* matrix of the closed-loop policy",
                 .see = "[below](#gains)",
                 .unit = "of the input per unit of the state",
                 .fallback_words = "from LQR"},
       .read = read_gain,
       .write = gain_text},
      {.about = {.name = "feedback_effort",
                 .values = {NumberValue{kPositive}},
                 .words = "factor on the weight of the input in that LQR, relative to the cost: "
                          "larger values give gentler gains",
                 .see = "[below](#gains)",
                 .fallback_words = "1; with risk limits, chosen during the drive"},
       .member = [](Scenario& scenario) -> double& { return scenario.controller.feedback_effort; },
       .is_written =
           [](const Scenario& scenario) { return scenario.controller.feedback_effort > 0.0; }},
      {.about = {.name = "optimise_gain",
                 .values = {FlagValue{}},
                 .words =
                     "whether a matrix added to the gains is optimised together with the inputs",
                 .see = "[below](#gains)"},
       .member = [](Scenario& scenario) -> bool& { return scenario.controller.optimise_gain; },
       .check = check_optimise_gain},
      {.about = {.name = "solver",
                 .values = {NameValue{solver_names()}},
                 .words = "a name from `qsmpc list solvers`",
                 .see = "[below](#solvers)"},
       .member = [](Scenario& scenario) -> std::string& { return scenario.controller.solver; }},
      {.about = {.name = "input_bounding",
                 .values = {NameValue{input_bounding_names()}},
                 .words = "how `lbfgs` keeps the input bounds, a name from `qsmpc list boundings`",
                 .see = "[below](#solvers)"},
       .member = [](Scenario& scenario) -> std::string& {
         return scenario.controller.input_bounding;
       },
       .check = check_input_bounding}};
}

ScenarioKey cost_key() {
  return {.about = {.name = "cost"},
          .keys = {{.about = {.name = "state",
                              .values = {MatrixValue{.is_identity_by_default = true}},
                              .words = "*n* × *n* weight of the distance to the target",
                              .fallback_words = "identity"},
                    .member = [](Scenario& scenario) -> Eigen::MatrixXd& {
                      return scenario.controller.cost.state;
                    }},
                   {.about = {.name = "input",
                              .values = {MatrixValue{.rows = Dimension::kInputs,
                                                     .cols = Dimension::kInputs,
                                                     .is_identity_by_default = true}},
                              .words = "*m* × *m* weight of the input",
                              .fallback_words = "identity"},
                    .member = [](Scenario& scenario) -> Eigen::MatrixXd& {
                      return scenario.controller.cost.input;
                    }},
                   {.about = {.name = "terminal",
                              .values = {MatrixValue{}},
                              .words = "*n* × *n* weight at the end of the horizon",
                              .fallback_words = "`cost.state`"},
                    .member = [](Scenario& scenario) -> Eigen::MatrixXd& {
                      return scenario.controller.cost.terminal;
                    },
                    .read = read_terminal_cost}}};
}

ScenarioKey penalty_key() {
  return {
      .about = {.name = "penalty"},
      .keys =
          {{.about = {.name = "shape",
                      .values = {NameValue{penalty_shape_names()}},
                      .words = "`smooth`, or `thesis`: Algorithm 2 of the reference thesis, which "
                               "supports only boxes of states"},
            .member = [](Scenario& scenario) -> std::string& {
              return scenario.controller.penalty.shape;
            },
            .check = check_penalty_shape},
           {.about = {.name = "box",
                      .values = {NumberValue{kNotNegative}},
                      .words = "weight of leaving the bounds, {range}; not used by `slsqp`",
                      .see = "[below](#solvers)",
                      .fallback_words = "450; 0 where risk limits are kept"},
            .member = [](Scenario& scenario) -> double& { return scenario.controller.penalty.box; },
            .read =
                [](ScenarioReading& reading, Section& section, const KeyDescription& about) {
                  read_weight(reading, section, about, reading.scenario.controller.penalty.box);
                }},
           {.about = {.name = "obstacle",
                      .values = {NumberValue{kNotNegative}},
                      .words = "weight of entering an obstacle",
                      .fallback_words = "400; 0 where risk limits are kept"},
            .member = [](Scenario& scenario) -> double& {
              return scenario.controller.penalty.obstacle;
            },
            .read =
                [](ScenarioReading& reading, Section& section, const KeyDescription& about) {
                  read_weight(reading, section, about,
                              reading.scenario.controller.penalty.obstacle);
                }},
           {.about = {.name = "length",
                      .values = {NumberValue{kPositive}},
                      .words = "distance outside the unsafe set at which the smooth shape begins",
                      .unit = "m"},
            .member = [](Scenario& scenario) -> double& {
              return scenario.controller.penalty.length;
            }}},
      .layout = SectionLayout::kFlow};
}

ScenarioKey input_bounds_key() {
  return {.about = {.name = "input_bounds",
                    .values = {MappingValue{{{.name = "INPUT",
                                              .family = NameFamily::kInputs,
                                              .values = {IntervalValue{.finite = true}},
                                              .words = "`[lower, upper]`, finite",
                                              .unit = "of the input",
                                              .fallback_words = "the system's"}}}}},
          .read = read_input_bounds,
          .write = [](const Scenario& scenario, const models::SystemDescription& system) {
            const Scenario::Controller& controller = scenario.controller;
            return std::optional(
                intervals_text({controller.input_lower, controller.input_upper}, system.inputs));
          }};
}

std::vector<ScenarioKey> effort_keys() {
  return {
      {.about = {.name = "deadline",
                 .values = {NumberValue{kDeadlineRange}},
                 .words = "time after which planning is cut short and a controller outside the "
                          "program counts as failed",
                 .see = "[below](#deadline-and-threads)",
                 .unit = "s",
                 .fallback_words = "none; 10 for `external`, `library` and `object`"},
       .member = [](Scenario& scenario) -> double& { return scenario.controller.deadline; },
       .is_written =
           [](const Scenario& scenario) { return std::isfinite(scenario.controller.deadline); }},
      {.about = {.name = "max_iterations",
                 .values = {kIterationsRange},
                 .words =
                     "maximum number of evaluations of cost and gradient in one plan, {range}; "
                     "those with which a cold start finds the way round obstacles are not counted"},
       .member = [](Scenario& scenario) -> int& { return scenario.controller.max_iterations; }},
      {.about = {.name = "threads",
                 .values = {kThreadsRange},
                 .words = "number of threads that share loops over many particles",
                 .see = "[below](#deadline-and-threads)"},
       .member = [](Scenario& scenario) -> int& { return scenario.controller.threads; }}};
}

void append(std::vector<ScenarioKey>& keys, std::vector<ScenarioKey> more) {
  keys.insert(keys.end(), std::make_move_iterator(more.begin()),
              std::make_move_iterator(more.end()));
}

}  // namespace

ScenarioKey controller_key() {
  std::vector<ScenarioKey> keys = kind_keys();
  keys.push_back(mppi_key());
  append(keys, outside_controller_keys());
  for (ScenarioKey (*make)() : {chance_key, shield_key}) keys.push_back(make());
  append(keys, plan_keys());
  append(keys, prediction_keys());
  for (ScenarioKey (*make)() : {cost_key, penalty_key, input_bounds_key}) keys.push_back(make());
  append(keys, effort_keys());
  return {.about = {.name = "controller"},
          .keys = std::move(keys),
          .after = ReadAfter::kSystem,
          .table = "controller"};
}

}  // namespace qsmpc::harness
