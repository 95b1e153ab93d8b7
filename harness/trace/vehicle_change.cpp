#include "harness/trace/vehicle_change.hpp"

#include <fmt/format.h>

#include "harness/errors.hpp"
#include "harness/mujoco/mujoco_model.hpp"
#include "harness/text/printable.hpp"

namespace qsmpc::harness {

std::string vehicle_change(const Trace& trace) {
  const std::string& path = trace.scenario.plant.mjcf;
  if (trace.vehicle_digest.empty() || path.empty()) return {};
  try {
    if (mujoco_model_digest(path) == trace.vehicle_digest) return {};
  } catch (const InputError&) {
    return {};  // the drawing code reports it
  }
  constexpr std::size_t kLongestPath = 200;
  return fmt::format("{} has changed since the drive; the vehicle is drawn from the current file.",
                     printable(path, kLongestPath));
}

}  // namespace qsmpc::harness
