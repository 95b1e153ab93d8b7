// A controller that is an object or a function of the calling program: in C++, or in Python through
// the module.
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

/// The functions of such a controller. An exception from one of them ends the drive as a fault of
/// the controller, except Interrupted.
struct ControllerObject {
  std::string name = "object";  ///< its name in messages, traces and pages
  /// Whether every answer contains a plan over the scenario's horizon, which is then certified.
  bool plans = false;
  /// Called before the first period of each drive, with its seed; may be empty.
  std::function<void(std::uint64_t)> reset{};
  /// Called once per period.
  std::function<ControllerAnswer(const controller::Situation&)> act{};
  /// Messages for the user about the drive so far; may be empty.
  std::function<std::string()> log{};
};

/// `scenario` with `object` as its controller, as recorded in the traces of its drives.
[[nodiscard]] Scenario with_controller(Scenario scenario, const ControllerObject& object);

}  // namespace qsmpc::harness

#pragma GCC visibility pop
