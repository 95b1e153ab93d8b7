#include "harness/scenario/controller_reader.hpp"

#include <string>
#include <utility>

#include "controller/planning/solvers/ocp_solver.hpp"
#include "harness/scenario/known_names.hpp"
#include "harness/scenario/section_values.hpp"
#include "harness/scenario/value_checks.hpp"

namespace qsmpc::harness {
namespace {

constexpr double kLongestDeadline = 1e6;  // s; well within what a clock can count
constexpr WholeRange kHorizonRange{1, kMostStages};
constexpr WholeRange kPointsRange{1, 100000};
constexpr WholeRange kIterationsRange{1, 100000};
constexpr WholeRange kThreadsRange{1, 256};
constexpr NumberRange kDeadlineRange{.least = 0.0, .most = kLongestDeadline, .above_least = true};

class ControllerReader {
 public:
  ControllerReader(Section& section, const models::SystemDescription& system)
      : section_(section), system_(system) {}

  Scenario::Controller read() {
    read_kind();
    controller_.horizon = section_.whole("horizon", controller_.horizon, kHorizonRange);
    controller_.policy = section_.name("policy", controller_.policy, policy_names());
    read_gain();
    read_solver();
    read_propagation();
    read_quantisation();
    read_cost();
    read_penalty();
    read_input_bounds();
    section_.refuse_unread();
    return std::move(controller_);
  }

 private:
  void read_kind();
  void read_gain();
  void read_solver();
  void read_propagation();
  void read_quantisation();
  void read_cost();
  void read_penalty();
  void read_input_bounds();

  [[nodiscard]] Eigen::Index state_dim() const { return std::ssize(system_.states); }
  [[nodiscard]] Eigen::Index input_dim() const { return std::ssize(system_.inputs); }

  Section& section_;
  const models::SystemDescription& system_;
  Scenario::Controller controller_;
};

// What only one controller reads is refused for the others, unless it says what holds anyway.
void ControllerReader::read_kind() {
  controller_.kind = section_.name("kind", controller_.kind, controller_names());
  Section lqr = section_.section("lqr");
  const std::string fallback = controller_.lqr_about;
  controller_.lqr_about = lqr.name("about", fallback, lqr_about_names());
  if (controller_.kind != "lqr" && controller_.lqr_about != fallback) {
    lqr.note("about", fallback + ", or controller.kind: lqr");
  }
  lqr.refuse_unread();
}

void ControllerReader::read_gain() {
  controller_.feedback_gain = section_.matrix("feedback_gain", input_dim(), state_dim());
  controller_.optimise_gain = section_.flag("optimise_gain", controller_.optimise_gain);
  if (controller_.optimise_gain && controller_.policy != "closed_loop") {
    section_.note("optimise_gain", "false, or controller.policy: closed_loop");
  }
}

void ControllerReader::read_solver() {
  controller_.solver = section_.name("solver", controller_.solver, solver_names());
  const std::string fallback = controller_.input_bounding;
  controller_.input_bounding = section_.name("input_bounding", fallback, input_bounding_names());
  if (!controller::solver_entry(controller_.solver).chooses_bounding &&
      controller_.input_bounding != fallback) {
    section_.note("input_bounding", fallback + ", or controller.solver: lbfgs");
  }
  controller_.max_iterations =
      section_.whole("max_iterations", controller_.max_iterations, kIterationsRange);
  controller_.deadline = section_.number("deadline", controller_.deadline, kDeadlineRange);
  controller_.threads = section_.whole("threads", controller_.threads, kThreadsRange);
}

// A way of propagating noise that is then not propagated is a contradiction, unless it is the
// default: that stands in every resolved scenario.
void ControllerReader::read_propagation() {
  controller_.propagate_noise = section_.flag("propagate_noise", controller_.propagate_noise);
  const std::string fallback = controller_.propagator;
  controller_.propagator = section_.name("propagator", fallback, propagator_names());
  if (!controller_.propagate_noise && controller_.propagator != fallback) {
    section_.note("propagator", fallback + ", or controller.propagate_noise: true");
  }
}

void ControllerReader::read_quantisation() {
  Section section = section_.section("quantisation");
  Scenario::Quantisation& points = controller_.quantisation;
  points.state = section.whole("state", points.state, kPointsRange);
  points.noise = section.whole("noise", points.noise, kPointsRange);
  points.compressed = section.whole("compressed", points.compressed, kPointsRange);
  points.quantiser = section.name("quantiser", points.quantiser, quantiser_names());
  section.refuse_unread();
}

void ControllerReader::read_cost() {
  Section section = section_.section("cost");
  Scenario::Cost& cost = controller_.cost;
  cost.state = semidefinite(section, "state", Eigen::MatrixXd::Identity(state_dim(), state_dim()));
  cost.input = semidefinite(section, "input", Eigen::MatrixXd::Identity(input_dim(), input_dim()));
  cost.terminal = semidefinite(section, "terminal", cost.state);
  section.refuse_unread();
}

void ControllerReader::read_penalty() {
  Section section = section_.section("penalty");
  Scenario::Penalty& penalty = controller_.penalty;
  penalty.shape = section.name("shape", penalty.shape, penalty_shape_names());
  penalty.box = section.number("box", penalty.box, kNotNegative);
  penalty.obstacle = section.number("obstacle", penalty.obstacle, kNotNegative);
  penalty.length = section.number("length", penalty.length, kPositive);
  section.refuse_unread();
}

void ControllerReader::read_input_bounds() {
  Section section = section_.section("input_bounds");
  const controller::Box limits{.lower = system_.input_lower, .upper = system_.input_upper};
  controller::Box bounds =
      read_intervals(section, system_.inputs, {.fallback = limits, .finite = true}).box;
  controller_.input_lower = std::move(bounds.lower);
  controller_.input_upper = std::move(bounds.upper);
}

}  // namespace

Scenario::Controller read_controller(Section& section, const models::SystemDescription& system) {
  return ControllerReader(section, system).read();
}

}  // namespace qsmpc::harness
