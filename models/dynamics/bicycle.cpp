#include "models/dynamics/bicycle.hpp"

#include <limits>
#include <numbers>
#include <stdexcept>

#include "models/dynamics/bicycle_batch.hpp"
#include "models/dynamics/parameter_checks.hpp"
#include "models/dynamics/templated_dynamics.hpp"

namespace qsmpc::models {
namespace {

constexpr const char* kBicycleName = "bicycle";
constexpr const char* kBicycleSummary =
    "Dynamic bicycle on linear tyres: x, y, heading, two speeds, yaw rate; accelerated and steered "
    "(Eq. 5-4)";

// Section 5-3-1.
constexpr double kLeastAcceleration = -5.0;                        // m/s²
constexpr double kLargestAcceleration = 2.0;                       // m/s²
constexpr double kLargestSteeringAngle = 0.25 * std::numbers::pi;  // rad

/// Batches use hand-written loops.
class BicycleDynamics final : public TemplatedDynamics<Bicycle> {
 public:
  using TemplatedDynamics::TemplatedDynamics;

  void step(const BatchView& states, const BatchView& inputs, BatchOut next) const override {
    step_bicycle(model(), states, inputs, next);
  }

  void pullback(const BatchView& states, const BatchView& inputs, const BatchView& next_adjoint,
                BatchOut state_adjoint, BatchOut input_adjoint) const override {
    pullback_bicycle(model(), states, inputs, next_adjoint, state_adjoint, input_adjoint);
  }
};

}  // namespace

SystemDescription Bicycle::description() const {
  SystemDescription description;
  description.name = kBicycleName;
  description.summary = kBicycleSummary;
  description.states = {{"x", "m"},
                        {"y", "m"},
                        {"heading", "rad", true},
                        {"longitudinal_speed", "m/s"},
                        {"lateral_speed", "m/s"},
                        {"yaw_rate", "rad/s"}};
  description.inputs = {{"acceleration", "m/s^2"}, {"steering_angle", "rad"}};
  description.input_lower = Eigen::Vector2d(kLeastAcceleration, -kLargestSteeringAngle);
  description.input_upper = Eigen::Vector2d(kLargestAcceleration, kLargestSteeringAngle);
  description.position_x = kX;
  description.position_y = kY;
  description.heading = kHeading;
  return description;
}

// ∂x⁺/∂φ is T times the speed, which is unbounded, and the poles are in the state space: no global
// constant exists for any gain. Over a box there is one, see local_lipschitz.hpp.
double Bicycle::lipschitz(const Eigen::Ref<const Eigen::MatrixXd>& gain) const {
  if (gain.rows() != kInputDim || gain.cols() != kStateDim) {
    throw std::invalid_argument("bicycle: the feedback gain must be 2 x 6");
  }
  return std::numeric_limits<double>::infinity();
}

std::unique_ptr<const Dynamics> make_bicycle(const ParameterMap& parameters, double time_step) {
  check_time_step(kBicycleName, time_step);
  return std::make_unique<BicycleDynamics>(Bicycle{
      .mass = positive_parameter(kBicycleName, parameters, "mass"),
      .yaw_inertia = positive_parameter(kBicycleName, parameters, "yaw_inertia"),
      .front_axle_distance = positive_parameter(kBicycleName, parameters, "front_axle_distance"),
      .rear_axle_distance = positive_parameter(kBicycleName, parameters, "rear_axle_distance"),
      .front_tyre_stiffness = negative_parameter(kBicycleName, parameters, "front_tyre_stiffness"),
      .rear_tyre_stiffness = negative_parameter(kBicycleName, parameters, "rear_tyre_stiffness"),
      .time_step = time_step});
}

SystemEntry bicycle_entry() {
  return {.name = kBicycleName,
          .summary = kBicycleSummary,
          .defaults = {{"mass", 1412.0},  // Table B-2
                       {"yaw_inertia", 1536.7},
                       {"front_axle_distance", 1.06},
                       {"rear_axle_distance", 1.85},
                       {"front_tyre_stiffness", -128916.0},
                       {"rear_tyre_stiffness", -85944.0}},
          .units = {{"mass", "kg"},
                    {"yaw_inertia", "kg m^2"},
                    {"front_axle_distance", "m"},
                    {"rear_axle_distance", "m"},
                    {"front_tyre_stiffness", "N/rad"},
                    {"rear_tyre_stiffness", "N/rad"}}};
}

}  // namespace qsmpc::models
