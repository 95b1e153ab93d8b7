// How a system's states and inputs appear in a MuJoCo model, as plain values: elements by name, and
// what the model's file itself cannot hold. Given by a scenario (`plant.state`, `plant.input`, …)
// or by a MuJoCo file in a custom text; plant_mapping_reader.hpp reads both. Keys and their
// meaning: docs/plants.md.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#pragma GCC visibility push(default)

namespace qsmpc::harness {

/// The kind of element of a MuJoCo model that holds a number.
enum class QuantitySource { kJoint, kBody, kSensor };

/// A state = gain · quantity + offset.
struct PlantQuantity {
  QuantitySource source = QuantitySource::kJoint;
  std::string element;   ///< name of the joint, body or sensor
  std::string quantity;  ///< one of `joint_quantities` or `body_quantities`; empty for a sensor
  int component = 0;     ///< index among a sensor's numbers
  double gain = 1.0;     ///< not 0
  double offset = 0.0;
};

/// "position" (m or rad) and "velocity" (m/s or rad/s) of a slide or hinge joint.
[[nodiscard]] const std::vector<std::string>& joint_quantities();

/// Of a body: "x", "y", "z" (m, of its origin in the world), "roll", "pitch", "yaw" (rad, yaw
/// unwrapped over turns), "velocity_x", "velocity_y" (m/s, in world axes), "forward_speed",
/// "lateral_speed" (m/s, of its origin along its own level x and y axes), "yaw_rate" (rad/s, about
/// the world's z axis).
[[nodiscard]] const std::vector<std::string>& body_quantities();

/// The quantities of joints and bodies that are velocities.
[[nodiscard]] const std::vector<std::string>& velocity_quantities();

/// The term that an input adds to an actuator's control: gain · input + offset.
struct ControlTerm {
  std::string actuator;
  double gain = 1.0;
  double offset = 0.0;
};

/// A number: the named constant of the system times `gain` or, without a name, `gain` itself.
struct PlantConstant {
  std::string parameter;
  double gain = 1.0;
};

/// A constant that is added to an actuator's control.
struct HoldTerm {
  std::string actuator;
  PlantConstant constant;
};

/// A wheel steered about a joint by a servo whose control is the angle (rad).
struct SteeredWheel {
  std::string joint;
  std::string actuator;
};

/// Low-level loop: turns the input into the angle of each steered wheel at which it rolls without
/// slip while the vehicle turns about a point in line with its fixed axle. The input is a yaw rate
/// (rad/s), which requires `speed`, or else the steering angle (rad) of a wheel in the middle.
struct AckermannLoop {
  std::string input;
  std::optional<PlantConstant> speed;   ///< m/s, > 0
  std::vector<SteeredWheel> wheels;     ///< at least one
  std::vector<std::string> fixed_axle;  ///< joints of the unsteered wheels, at least one
};

/// Low-level loop: the velocity servo `actuator` (rad/s) holds the driven wheels at the angular
/// velocity that corresponds to `speed`.
struct SpeedHoldLoop {
  PlantConstant speed;  ///< m/s, > 0
  std::string actuator;
  std::string wheel;  ///< joint of a driven wheel
};

/// Forces on a body that moves in the plane, Eq. 5-4 of the reference thesis: linear tyres at two
/// axles, and the force that produces the forward acceleration.
struct AxleForces {
  std::string body;
  std::string acceleration;      ///< input, m/s²
  std::string steering;          ///< input, rad
  std::string front_axle;        ///< site
  std::string rear_axle;         ///< site
  double front_stiffness = 0.0;  ///< N/rad, > 0
  double rear_stiffness = 0.0;   ///< N/rad, > 0
  double slowest = 0.0;          ///< m/s, > 0: lower limit of the speed in the slip
};

struct TyreWheel {
  std::string joint;                 ///< the wheel's axis of rotation
  double cornering_stiffness = 0.0;  ///< N/rad, > 0
};

/// Tyre forces where wheels touch the ground: longitudinal and lateral slip, jointly limited by
/// friction times load.
struct TyreForces {
  std::vector<TyreWheel> wheels;        ///< at least one
  double longitudinal_stiffness = 0.0;  ///< N per unit of slip, > 0
  double friction = 0.0;                ///< > 0
  double slowest = 0.0;                 ///< m/s, > 0: lower limit of the speed in the slip
};

/// Low-level loop: force or torque actuators hold a velocity of the vehicle at a constant, or at
/// gain · input, which it then follows with a first-order lag of `time_constant`.
struct FeedbackLoop {
  PlantQuantity quantity;              ///< a velocity
  std::string input;                   ///< that sets the goal; empty where the goal is constant
  PlantConstant goal;                  ///< the constant; with an input, only `gain` is used
  std::vector<ControlTerm> actuators;  ///< at least one; gains only: their shares of the command
  double time_constant = 0.1;          ///< s, > 0
  /// The velocity's rate per unit of the command, not 0; measured during settling if absent.
  std::optional<double> response;
};

/// What a gait adds to the control of an actuator at the time t (s) since the vehicle was placed:
/// (amplitude + gain · input) · sin 2π(t/cycle + phase).
struct GaitSwing {
  std::string actuator;
  double amplitude = 0.0;
  std::string input;   ///< empty: none
  double gain = 1.0;   ///< of the input, not 0
  double phase = 0.0;  ///< share of a cycle
};

/// Low-level loop: a periodic motion of actuators, such as of legs, whose stride depends on inputs.
struct GaitLoop {
  double cycle = 1.0;                ///< s, > 0
  std::vector<GaitSwing> actuators;  ///< at least one
};

using PlantLoop =
    std::variant<AckermannLoop, SpeedHoldLoop, AxleForces, TyreForces, FeedbackLoop, GaitLoop>;

/// The range of simulator time steps that a model is valid for, s.
struct TimeStepRange {
  double least = 0.0;
  double most = 0.0;
};

struct PlantMapping {
  std::map<std::string, PlantQuantity> states;             ///< one for each state of the system
  std::map<std::string, std::vector<ControlTerm>> inputs;  ///< direct terms, without a loop
  std::vector<HoldTerm> holds;
  std::vector<PlantLoop> loops;
  std::vector<std::string> rolling;           ///< joints of wheels that are set spinning on reset
  std::map<std::string, double> rate_limits;  ///< of controls, by actuator, unit/s
  double input_delay = 0.0;                   ///< s, before an input takes effect
  double settling = 1.0;                      ///< s, simulated before the vehicle is placed
  std::optional<TimeStepRange> time_steps;
};

}  // namespace qsmpc::harness

#pragma GCC visibility pop
