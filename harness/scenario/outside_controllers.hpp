// Controllers that are not part of the program: processes and shared libraries of the user, which
// harness/control starts, asks and ends; and objects of a program that links the library.
#pragma once

#include <string>
#include <vector>

#include "harness/scenario/scenario.hpp"

namespace qsmpc::harness {

inline constexpr const char* kExternalController = "external";
inline constexpr const char* kLibraryController = "library";
/// Handed over by the program that drives. No scenario file can start one.
inline constexpr const char* kObjectController = "object";

struct OutsideControllerEntry {
  std::string name;
  std::string summary;
};

/// The kinds that there are.
[[nodiscard]] const std::vector<OutsideControllerEntry>& outside_controllers();

/// Whether the controller is of one of these kinds.
[[nodiscard]] bool is_outside(const Scenario::Controller& controller);

/// How long an answer may take: the controller's deadline, or 10 s where it has none. In s.
[[nodiscard]] double answer_deadline(const Scenario::Controller& controller);

/// What messages call it: the command on one line, the file name of the library, or the name of the
/// object.
[[nodiscard]] std::string outside_controller_name(const Scenario::Controller& controller);

}  // namespace qsmpc::harness
