// A point in the plane, driven by the acceleration along each axis, which is held over the period,
// and slowed by viscous damping. The step is exact.
#pragma once

#include <memory>

#include <Eigen/Core>

#include "models/dynamics/dynamics.hpp"

namespace qsmpc::models {

/// With T the period and c the damping: ẍ = a − c ẋ along each axis.
struct PointMass {
  static constexpr int kStateDim = 4;
  static constexpr int kInputDim = 2;
  static constexpr int kAxes = 2;
  enum State { kX = 0, kY = 1, kVelocityX = 2, kVelocityY = 3 };
  enum Input { kAccelerationX = 0, kAccelerationY = 1 };

  double decay;       ///< e^(−cT)
  double speed_gain;  ///< s: (1 − e^(−cT))/c
  double reach;       ///< s²: (T − speed_gain)/c

  template <class Scalar>
  void step(const Scalar* x, const Scalar* u, Scalar* next) const {
    for (int axis = 0; axis < kAxes; ++axis) {
      const int velocity = kVelocityX + axis;
      next[axis] = x[axis] + speed_gain * x[velocity] + reach * u[axis];
      next[velocity] = decay * x[velocity] + speed_gain * u[axis];
    }
  }

  [[nodiscard]] SystemDescription description() const;

  /// See Dynamics::lipschitz; finite for every gain, and attained.
  [[nodiscard]] double lipschitz(const Eigen::Ref<const Eigen::MatrixXd>& gain) const;
};

/// Throws std::invalid_argument unless time_step (s) is finite and above 0, and the parameter
/// `damping` (1/s) finite and not below 0.
[[nodiscard]] std::unique_ptr<const Dynamics> make_point_mass(const ParameterMap& parameters,
                                                              double time_step);

/// The entry in the table of systems.
[[nodiscard]] SystemEntry point_mass_entry();

}  // namespace qsmpc::models
