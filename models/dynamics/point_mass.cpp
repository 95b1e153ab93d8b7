#include "models/dynamics/point_mass.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "models/dynamics/parameter_checks.hpp"
#include "models/dynamics/templated_dynamics.hpp"
#include "models/linear_algebra.hpp"

namespace qsmpc::models {
namespace {

constexpr double kDefaultPush = 2.0;    // m/s²
constexpr double kSmallDamping = 1e-4;  // below this c T the series is as accurate
constexpr const char* kPointMassName = "point_mass";
constexpr const char* kPointMassSummary =
    "Point in the plane: position, velocity; driven by its acceleration along x and y";

}  // namespace

SystemDescription PointMass::description() const {
  SystemDescription description;
  description.name = kPointMassName;
  description.summary = kPointMassSummary;
  description.states = {{"x", "m"}, {"y", "m"}, {"velocity_x", "m/s"}, {"velocity_y", "m/s"}};
  description.inputs = {{"acceleration_x", "m/s^2"}, {"acceleration_y", "m/s^2"}};
  description.input_lower = Eigen::VectorXd::Constant(kInputDim, -kDefaultPush);
  description.input_upper = Eigen::VectorXd::Constant(kInputDim, kDefaultPush);
  description.position_x = kX;
  description.position_y = kY;
  return description;
}

// Where the clamp is differentiable the closed loop's Jacobian is A + B S K with the clamp's slopes
// S = diag(s), s ∈ {0, 1}², and the Lipschitz constant of a piecewise affine function is the
// largest norm of its pieces' matrices.
double PointMass::lipschitz(const Eigen::Ref<const Eigen::MatrixXd>& gain) const {
  if (gain.rows() != kInputDim || gain.cols() != kStateDim) {
    throw std::invalid_argument("point_mass: the feedback gain must be 2 x 4");
  }
  double largest = 0.0;
  for (const double along_x : {0.0, 1.0}) {
    for (const double along_y : {0.0, 1.0}) {
      const double slopes[] = {along_x, along_y};
      Eigen::MatrixXd closed = Eigen::MatrixXd::Identity(kStateDim, kStateDim);
      for (int axis = 0; axis < kAxes; ++axis) {
        const int velocity = kVelocityX + axis;
        closed(axis, velocity) = speed_gain;
        closed(velocity, velocity) = decay;
        closed.row(axis) += reach * slopes[axis] * gain.row(axis);
        closed.row(velocity) += speed_gain * slopes[axis] * gain.row(axis);
      }
      largest = std::max(largest, spectral_norm(closed));
    }
  }
  return largest;
}

std::unique_ptr<const Dynamics> make_point_mass(const ParameterMap& parameters, double time_step) {
  check_time_step(kPointMassName, time_step);
  const double damping = non_negative_parameter(kPointMassName, parameters, "damping");
  const double decayed = damping * time_step;
  const double speed_gain = damping > 0.0 ? -std::expm1(-decayed) / damping : time_step;
  const double reach = decayed > kSmallDamping ? (time_step - speed_gain) / damping
                                               : time_step * time_step * (0.5 - decayed / 6.0);
  return std::make_unique<TemplatedDynamics<PointMass>>(
      PointMass{.decay = std::exp(-decayed), .speed_gain = speed_gain, .reach = reach});
}

SystemEntry point_mass_entry() {
  return {.name = kPointMassName,
          .summary = kPointMassSummary,
          .defaults = {{"damping", 0.0}},
          .units = {{"damping", "1/s"}}};
}

}  // namespace qsmpc::models
