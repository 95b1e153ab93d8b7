// Controllers of tests/data/controllers, one of each kind, for short drives on the model itself.
#pragma once

#include <string>
#include <vector>

#include "harness/scenario/scenario.hpp"
#include "harness/scenario/scenario_file.hpp"

namespace qsmpc::harness {

enum class OutsideKind { kExternal, kLibrary, kOwnClass };

inline std::string data_folder() {
  return std::string(QSMPC_SOURCE_DIR) + "/tests/data/controllers";
}

inline std::string library_file(const std::string& name) {
  return std::string(QSMPC_BINARY_DIR) + "/tests/controllers/" + name + ".so";
}

inline std::vector<std::string> controller_overrides(OutsideKind kind) {
  if (kind == OutsideKind::kExternal) {
    return {"controller.kind=external",
            "controller.command=[python3, " + data_folder() + "/responder.py]"};
  }
  return {"controller.kind=library",
          "controller.library=" + library_file(kind == OutsideKind::kLibrary ? "library" : "own")};
}

/// A drive of six periods; `more` follows the overrides of the kind.
inline Scenario outside_scenario(OutsideKind kind, const std::vector<std::string>& more = {}) {
  std::vector<std::string> overrides = {
      "controller.horizon=5", "controller.quantisation={state: 20, noise: 20, compressed: 20}",
      "limit.steps=6", "plant.kind=analytic", "vehicle.footprint=point"};
  for (const std::string& one : controller_overrides(kind)) overrides.push_back(one);
  overrides.insert(overrides.end(), more.begin(), more.end());
  return load_scenario("dubins_obstacles", overrides);
}

/// A scenario whose controller misbehaves in period 2.
inline Scenario failing_scenario(OutsideKind kind, const std::string& mode) {
  // The answers before it take far less time than the deadline, even on a busy machine.
  return outside_scenario(kind, {"controller.options.mode=" + mode, "controller.deadline=3"});
}

}  // namespace qsmpc::harness
