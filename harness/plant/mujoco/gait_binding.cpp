#include "harness/plant/mujoco/gait_binding.hpp"

#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "harness/errors.hpp"
#include "harness/plant/mujoco/control_binding.hpp"

namespace qsmpc::harness {

GaitBinding::GaitBinding(const NamedModel& named, const GaitLoop& loop,
                         const models::SystemDescription& system, double settling)
    : cycle_(loop.cycle) {
  for (const GaitSwing& swing : loop.actuators) {
    swings_.push_back({.actuator = element_index(named, mjOBJ_ACTUATOR, swing.actuator),
                       .amplitude = swing.amplitude,
                       .input = swing.input.empty() ? -1 : input_index(system, swing.input),
                       .gain = swing.gain,
                       .phase = swing.phase});
  }
  constexpr double kRounding = 1e-9;
  constexpr double kLeastSteps = 10.0;
  const double step = named.model.opt.timestep;
  if (cycle_ < kLeastSteps * step * (1.0 - kRounding)) {
    throw InputError(
        {.key = "plant.loops",
         .found = fmt::format("a gait with a cycle of {} s, {:.3g} steps of the simulator", cycle_,
                              cycle_ / step),
         .expected = fmt::format("a cycle of at least ten steps, {} s", kLeastSteps * step)});
  }
  const double cycles = settling / cycle_;
  if (std::abs(cycles - std::round(cycles)) <= kRounding * cycles) return;
  throw InputError(
      {.key = "plant.settling",
       .found = fmt::format("{} s, {:.4g} cycles of a gait of {} s", settling, cycles, cycle_),
       .expected = "a whole number of cycles, so that the gait goes on where it was "
                   "when the vehicle is placed"});
}

void GaitBinding::add(double time, const Eigen::VectorXd& input, Eigen::VectorXd& controls) const {
  for (const Swing& swing : swings_) {
    const double amplitude =
        swing.amplitude + (swing.input < 0 ? 0.0 : swing.gain * input[swing.input]);
    controls[swing.actuator] +=
        amplitude * std::sin(2.0 * std::numbers::pi * (time / cycle_ + swing.phase));
  }
}

}  // namespace qsmpc::harness
