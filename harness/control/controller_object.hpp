// A controller that is an object, or a function, of the program that drives: in C++, or in Python
// by the module.
//
//   const Trace trace = run_episode(scenario, {.seed = 1}, {.act = [&](const Situation& now) {
//     return ControllerAnswer{.input = gain * now.observation};
//   }});
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "controller/control/controller.hpp"
#include "harness/control/controller_answer.hpp"
#include "harness/scenario/scenario.hpp"

#pragma GCC visibility push(default)

namespace qsmpc::harness {

/// What such a controller does. What a function throws ends the drive as a fault of the controller,
/// Interrupted excepted.
struct ControllerObject {
  std::string name = "object";  ///< what messages, traces and pages call it
  /// Whether every answer has a plan of the scenario's horizon, which is then certified.
  bool plans = false;
  /// Called before the first period of each drive, with its seed; may be empty.
  std::function<void(std::uint64_t)> reset{};
  /// Called once per period.
  std::function<ControllerAnswer(const controller::Situation&)> act{};
  /// What it has to say to people about the drive so far; may be empty.
  std::function<std::string()> log{};
};

/// `scenario` with the controller that `object` is, as traces of its drives record it.
[[nodiscard]] Scenario with_controller(Scenario scenario, const ControllerObject& object);

}  // namespace qsmpc::harness

#pragma GCC visibility pop
