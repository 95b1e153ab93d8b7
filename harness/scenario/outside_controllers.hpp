// Controllers outside the program: processes and shared libraries of the user, which
// harness/control starts, queries and ends; and objects of a program that links this library.
#pragma once

#include <string>
#include <vector>

#include "harness/scenario/scenario.hpp"

namespace qsmpc::harness {

inline constexpr const char* kExternalController = "external";
inline constexpr const char* kLibraryController = "library";
/// Supplied by the calling program; a scenario file cannot start one.
inline constexpr const char* kObjectController = "object";

struct OutsideControllerEntry {
  std::string name;
  std::string summary;
};

/// The kinds of such controllers.
[[nodiscard]] const std::vector<OutsideControllerEntry>& outside_controllers();

/// Whether the controller is of one of these kinds.
[[nodiscard]] bool is_outside(const Scenario::Controller& controller);

/// The time limit of an answer, s: the controller's deadline, or 10 s without one.
[[nodiscard]] double answer_deadline(const Scenario::Controller& controller);

/// The controller's name in messages: the command on one line, the file name of the library, or the
/// name of the object.
[[nodiscard]] std::string outside_controller_name(const Scenario::Controller& controller);

}  // namespace qsmpc::harness
