#include "harness/control/controller_answer.hpp"

#include <cmath>
#include <iterator>
#include <utility>

#include <fmt/format.h>

namespace qsmpc::harness {
namespace {

[[noreturn]] void refuse_answer(std::string found, std::string expected) {
  throw WrongAnswer{std::move(found), std::move(expected)};
}

/// "[0.5, nan]"
std::string shown(const Eigen::VectorXd& numbers) {
  std::string text;
  for (const double number : numbers) text += fmt::format("{}{}", text.empty() ? "" : ", ", number);
  return "[" + text + "]";
}

void check_plan(ControllerAnswer& answer, const AnswerShape& shape) {
  const auto inputs = std::ssize(shape.system.inputs);
  const auto states = std::ssize(shape.system.states);
  controller::Policy& policy = answer.policy;
  if (policy.inputs.rows() != inputs || policy.inputs.cols() != shape.stages) {
    refuse_answer(
        fmt::format("plan.inputs of {} stages with {} inputs", policy.inputs.cols(),
                    policy.inputs.rows()),
        fmt::format("{} stages with {} inputs (controller.horizon)", shape.stages, inputs));
  }
  for (Eigen::Index k = 0; k < shape.stages; ++k) {
    check_input(policy.inputs.col(k), shape, fmt::format("plan.inputs[{}]", k));
  }
  if (policy.gains.empty()) {
    policy.gains.assign(static_cast<std::size_t>(shape.stages),
                        Eigen::MatrixXd::Zero(inputs, states));
  }
  if (std::ssize(policy.gains) != shape.stages) {
    refuse_answer(fmt::format("plan.gains of {} stages", policy.gains.size()),
                  fmt::format("the gains of {} stages", shape.stages));
  }
  for (const Eigen::MatrixXd& gain : policy.gains) {
    if (gain.rows() == inputs && gain.cols() == states && gain.allFinite()) continue;
    refuse_answer(fmt::format("plan.gains of {} x {}{}", gain.rows(), gain.cols(),
                              gain.allFinite() ? "" : ", not finite"),
                  fmt::format("{} x {} finite numbers", inputs, states));
  }
}

}  // namespace

void check_input(const Eigen::VectorXd& input, const AnswerShape& shape, const std::string& what) {
  const auto count = std::ssize(shape.system.inputs);
  const std::string expected = fmt::format("{} finite numbers", count);
  if (input.size() != count) {
    refuse_answer(fmt::format("{} of {} numbers: {}", what, input.size(), shown(input)), expected);
  }
  if (!input.allFinite()) refuse_answer(what + " " + shown(input), expected);
  for (Eigen::Index i = 0; i < input.size(); ++i) {
    if (input[i] >= shape.bounds.lower[i] && input[i] <= shape.bounds.upper[i]) continue;
    const std::string& name = shape.system.inputs[static_cast<std::size_t>(i)].name;
    refuse_answer(
        fmt::format("{} with {} = {}, out of its bounds", what, name, input[i]),
        fmt::format("{} from {} to {}", name, shape.bounds.lower[i], shape.bounds.upper[i]));
  }
}

void check_believed(double believed) {
  if (believed >= 0.0 && believed <= 1.0) return;
  refuse_answer(fmt::format("believed {}", believed), "a probability from 0 to 1");
}

void complete_answer(ControllerAnswer& answer, const AnswerShape& shape) {
  if (answer.believed) check_believed(*answer.believed);
  if (shape.stages == 0) {
    check_input(answer.input, shape, "input");
  } else {
    check_plan(answer, shape);
  }
}

}  // namespace qsmpc::harness
