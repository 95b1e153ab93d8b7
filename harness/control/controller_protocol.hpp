// The messages between the program and a controller outside it: lines of JSON. docs/controllers.md
// is the reference.
#pragma once

#include <cstdint>
#include <string>

#include <Eigen/Core>

#include "controller/control/controller.hpp"
#include "harness/control/controller_answer.hpp"
#include "harness/scenario/scenario.hpp"
#include "models/dynamics/dynamics.hpp"

namespace qsmpc::harness {

/// Incremented with every change that an older controller would misread.
inline constexpr int kProtocolVersion = 1;

// Message types.
inline constexpr const char* kScenarioMessage = "scenario";
inline constexpr const char* kResetMessage = "reset";
inline constexpr const char* kSituationMessage = "situation";
inline constexpr const char* kEndMessage = "end";

/// The first message. Absent limits and bounds are null.
[[nodiscard]] std::string scenario_message(const Scenario& scenario,
                                           const models::SystemDescription& system);

/// Sent before the first period of each drive.
[[nodiscard]] std::string reset_message(std::uint64_t seed);

/// Sent once per period. deadline: s from now.
[[nodiscard]] std::string situation_message(const controller::Situation& situation,
                                            double deadline);

/// The last message.
[[nodiscard]] std::string end_message();

/// Throws WrongAnswer unless `line` answers the scenario with this version of the protocol.
void check_greeting(const std::string& line);

/// Reads the answer of period `period`. Throws WrongAnswer.
[[nodiscard]] ControllerAnswer read_answer(const std::string& line, std::int64_t period,
                                           const AnswerShape& shape);

}  // namespace qsmpc::harness
