// Controllers that are no part of the program: processes and shared libraries of the user's, which
// harness/control starts, asks and ends.
#pragma once

#include <string>
#include <vector>

#include "harness/scenario/scenario.hpp"

namespace qsmpc::harness {

inline constexpr const char* kExternalController = "external";
inline constexpr const char* kLibraryController = "library";

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

/// What messages call it: the command on one line, or the file name of the library.
[[nodiscard]] std::string outside_controller_name(const Scenario::Controller& controller);

}  // namespace qsmpc::harness
