// The double integrator (Eq. D-1, D-2): a point on a line, driven by its acceleration, which is
// held over the period. The classical Runge-Kutta step is exact for it.
#pragma once

#include <memory>

#include <Eigen/Core>

#include "models/dynamics/dynamics.hpp"

namespace qsmpc::models {

struct DoubleIntegrator {
  static constexpr int kStateDim = 2;
  static constexpr int kInputDim = 1;
  enum State { kPosition = 0, kVelocity = 1 };
  enum Input { kAcceleration = 0 };

  double time_step;  ///< s

  /// p⁺ = p + Tv + T²u/2, v⁺ = v + Tu.
  template <class Scalar>
  void step(const Scalar* x, const Scalar* u, Scalar* next) const {
    next[kPosition] =
        x[kPosition] + time_step * x[kVelocity] + (0.5 * time_step * time_step) * u[kAcceleration];
    next[kVelocity] = x[kVelocity] + time_step * u[kAcceleration];
  }

  [[nodiscard]] SystemDescription description() const;

  /// See Dynamics::lipschitz; finite for every gain, and attained.
  [[nodiscard]] double lipschitz(const Eigen::Ref<const Eigen::MatrixXd>& gain) const;
};

/// Throws std::invalid_argument unless time_step > 0 (s) and finite. It has no parameters.
[[nodiscard]] std::unique_ptr<const Dynamics> make_double_integrator(const ParameterMap& parameters,
                                                                     double time_step);

/// The entry in the table of systems.
[[nodiscard]] SystemEntry double_integrator_entry();

}  // namespace qsmpc::models
