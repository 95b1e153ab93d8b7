#include "harness/scenario/outside_controllers.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>

namespace qsmpc::harness {
namespace {

// A controller that takes longer is taken to hang.
constexpr double kAnswerDeadline = 10.0;  // s

}  // namespace

const std::vector<OutsideControllerEntry>& outside_controllers() {
  static const std::vector<OutsideControllerEntry> table = {
      {.name = kExternalController,
       .summary = "a program in any language that answers lines of JSON (controller.command)"},
      {.name = kLibraryController,
       .summary = "a shared library with the C interface (controller.library)"},
      {.name = kObjectController,
       .summary =
           "a Python or C++ object of the calling program; not available from the command line"},
  };
  return table;
}

bool is_outside(const Scenario::Controller& controller) {
  return std::ranges::find(outside_controllers(), controller.kind, &OutsideControllerEntry::name) !=
         outside_controllers().end();
}

double answer_deadline(const Scenario::Controller& controller) {
  return std::isfinite(controller.deadline) ? controller.deadline : kAnswerDeadline;
}

std::string outside_controller_name(const Scenario::Controller& controller) {
  if (controller.kind == kLibraryController) {
    return std::filesystem::path(controller.outside.library).filename().string();
  }
  std::string name;
  for (const std::string& word : controller.outside.command) {
    name += (name.empty() ? "" : " ") + word;
  }
  return name;
}

}  // namespace qsmpc::harness
