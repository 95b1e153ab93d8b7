// The controller's side of controller_protocol.hpp, parsed as untrusted input.
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "harness/control/controller_protocol.hpp"
#include "harness/text/printable.hpp"

namespace qsmpc::harness {
namespace {

using AnswerJson = nlohmann::json;

constexpr std::size_t kShown = 80;  // bytes of the answer shown in messages

std::string shown(const AnswerJson& json) {
  return printable(json.dump(-1, ' ', false, AnswerJson::error_handler_t::replace), kShown);
}

[[noreturn]] void refuse(std::string found, std::string expected) {
  throw WrongAnswer{std::move(found), std::move(expected)};
}

/// The object in `line`. An error that the controller reports is thrown as one.
AnswerJson object_in(const std::string& line, const std::string& expected) {
  AnswerJson json = AnswerJson::parse(line, nullptr, /*allow_exceptions=*/false);
  if (json.is_discarded())
    refuse("an answer that is not JSON: " + printable(line, kShown), expected);
  if (!json.is_object()) refuse("the answer " + shown(json), expected);
  if (const auto error = json.find("error"); error != json.end()) {
    refuse("its error: " + (error->is_string() ? error->get<std::string>() : shown(*error)),
           expected);
  }
  return json;
}

/// `count` finite numbers, called `what` in messages.
Eigen::VectorXd numbers(const AnswerJson& list, Eigen::Index count, const std::string& what) {
  const std::string expected = fmt::format("{} finite numbers", count);
  if (!list.is_array() || std::ssize(list) != count) {
    const std::string size =
        list.is_array() ? fmt::format("{} of {} numbers: ", what, list.size()) : what + " ";
    refuse(size + shown(list), expected);
  }
  Eigen::VectorXd values(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const AnswerJson& item = list[static_cast<std::size_t>(i)];
    values[i] = item.is_number() ? item.get<double>() : std::nan("");
    if (!std::isfinite(values[i])) refuse(what + " " + shown(list), expected);
  }
  return values;
}

Eigen::VectorXd input_in(const AnswerJson& list, const AnswerShape& shape,
                         const std::string& what) {
  Eigen::VectorXd input = numbers(list, std::ssize(shape.system.inputs), what);
  check_input(input, shape, what);
  return input;
}

Eigen::MatrixXd gain_in(const AnswerJson& rows, const AnswerShape& shape, const std::string& what) {
  const Eigen::Index inputs = std::ssize(shape.system.inputs);
  const Eigen::Index states = std::ssize(shape.system.states);
  if (!rows.is_array() || std::ssize(rows) != inputs) {
    refuse(what + " " + shown(rows), fmt::format("{} rows of {} numbers", inputs, states));
  }
  Eigen::MatrixXd gain(inputs, states);
  for (Eigen::Index i = 0; i < inputs; ++i) {
    gain.row(i) = numbers(rows[static_cast<std::size_t>(i)], states, what).transpose();
  }
  return gain;
}

controller::SolverStatus status_in(const AnswerJson& name) {
  using controller::SolverStatus;
  std::string known;
  for (const SolverStatus status :
       {SolverStatus::kConverged, SolverStatus::kIterationLimit, SolverStatus::kStalled,
        SolverStatus::kDeadline, SolverStatus::kInfeasible, SolverStatus::kRiskExceeded,
        SolverStatus::kNumericalTrouble}) {
    if (name == controller::solver_status_name(status)) return status;
    known += (known.empty() ? "" : ", ") + std::string(controller::solver_status_name(status));
  }
  refuse("plan.status " + shown(name), known);
}

int count_in(const AnswerJson& count) {
  constexpr int kMost = 1'000'000'000;
  if (!count.is_number_integer() || count < 0 || count > kMost) {
    refuse("plan.evaluations " + shown(count), "a whole number");
  }
  return count.get<int>();
}

/// The controller's own risk estimate, if it gives one.
std::optional<double> believed_in(const AnswerJson& json) {
  const auto believed = json.find("believed");
  if (believed == json.end() || believed->is_null()) return std::nullopt;
  if (!believed->is_number()) {
    refuse("believed " + shown(*believed), "a probability from 0 to 1, or null");
  }
  check_believed(believed->get<double>());
  return believed->get<double>();
}

void read_plan(const AnswerJson& plan, const AnswerShape& shape, ControllerAnswer& answer) {
  const auto inputs = plan.find("inputs");
  if (inputs == plan.end() || !inputs->is_array() || std::ssize(*inputs) != shape.stages) {
    refuse(inputs == plan.end() ? "a plan without inputs"
           : inputs->is_array() ? fmt::format("plan.inputs of {} stages", inputs->size())
                                : "plan.inputs " + shown(*inputs),
           fmt::format("the inputs of {} stages (controller.horizon)", shape.stages));
  }
  const auto gains = plan.find("gains");
  const bool has_gains = gains != plan.end() && !gains->is_null();
  if (has_gains && (!gains->is_array() || std::ssize(*gains) != shape.stages)) {
    refuse("plan.gains " + shown(*gains), fmt::format("the gains of {} stages", shape.stages));
  }
  const Eigen::Index dim = std::ssize(shape.system.inputs);
  answer.policy.inputs.resize(dim, shape.stages);
  answer.policy.gains.assign(static_cast<std::size_t>(shape.stages),
                             Eigen::MatrixXd::Zero(dim, std::ssize(shape.system.states)));
  for (int k = 0; k < shape.stages; ++k) {
    const auto at = static_cast<std::size_t>(k);
    const std::string place = fmt::format("[{}]", k);
    answer.policy.inputs.col(k) = input_in((*inputs)[at], shape, "plan.inputs" + place);
    if (has_gains) answer.policy.gains[at] = gain_in((*gains)[at], shape, "plan.gains" + place);
  }
  if (const auto status = plan.find("status"); status != plan.end()) {
    answer.status = status_in(*status);
  }
  if (const auto count = plan.find("evaluations"); count != plan.end()) {
    answer.evaluations = count_in(*count);
  }
}

}  // namespace

void check_greeting(const std::string& line) {
  const std::string expected = fmt::format("{{\"protocol\": {}}}", kProtocolVersion);
  const AnswerJson json = object_in(line, expected);
  const auto protocol = json.find("protocol");
  if (protocol == json.end()) refuse("the answer " + shown(json), expected);
  if (*protocol != kProtocolVersion) {
    refuse("version " + shown(*protocol) + " of the protocol",
           fmt::format("version {}", kProtocolVersion));
  }
}

ControllerAnswer read_answer(const std::string& line, std::int64_t period,
                             const AnswerShape& shape) {
  const bool plans = shape.stages > 0;
  const char* const key = plans ? "plan" : "input";
  const std::string expected = plans ? "{\"plan\": {\"inputs\": [[…], …]}}" : "{\"input\": […]}";
  const AnswerJson json = object_in(line, expected);
  if (const auto of = json.find("period"); of != json.end() && *of != period) {
    refuse("an answer for period " + shown(*of), fmt::format("one for period {}", period));
  }
  const auto value = json.find(key);
  if (value == json.end()) refuse("the answer " + shown(json), expected);
  ControllerAnswer answer;
  answer.believed = believed_in(json);
  if (!plans) {
    answer.input = input_in(*value, shape, "input");
    return answer;
  }
  if (!value->is_object()) refuse("plan " + shown(*value), expected);
  read_plan(*value, shape, answer);
  return answer;
}

}  // namespace qsmpc::harness
