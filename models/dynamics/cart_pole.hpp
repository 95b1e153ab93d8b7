// A pole on a cart (Eq. D-3 to D-5): the cart is pushed along a line, the pole hinged on it falls.
// Discretised by the classical Runge-Kutta method, with the force held over the period.
#pragma once

#include <cmath>
#include <memory>

#include <Eigen/Core>

#include "models/dynamics/dynamics.hpp"
#include "models/dynamics/runge_kutta.hpp"

namespace qsmpc::models {

struct CartPole {
  static constexpr int kStateDim = 4;
  static constexpr int kInputDim = 1;
  enum State { kPosition = 0, kVelocity = 1, kPoleAngle = 2, kAngularVelocity = 3 };
  enum Input { kForce = 0 };

  double cart_mass;         ///< M, kg
  double pole_mass;         ///< m, kg
  double pole_half_length;  ///< L, from the hinge to the centre of a uniform pole, m
  double gravity;           ///< g, m/s²
  double cart_damping = 0;  ///< c, between cart and rail, N s/m
  double pole_damping = 0;  ///< d, in the hinge, N m s/rad
  double time_step;         ///< s

  /// The pole stands upright at θ = 0, where g sin θ drives it away, and leans towards positive
  /// positions at θ > 0; it hangs at θ = π. (Table B-5 calls θ = π upright: with Eq. D-4 it is
  /// not.) With the share q = (F − c ṗ + m L θ̇² sin θ)/(M + m),
  ///
  ///     θ̈ = (g sin θ − q cos θ − d θ̇/(m L)) / (L (4/3 − m cos²θ/(M + m))),
  ///     p̈ = q − m L θ̈ cos θ/(M + m).
  ///
  /// The divisor is at least L/3. Eq. D-3 to D-5 are the case c = d = 0, in which the dampings cost
  /// no operations.
  template <class Scalar>
  void derivative(const Scalar* x, const Scalar& force, Scalar* slope) const {
    using std::cos;
    using std::sin;
    constexpr double kUniformPole = 4.0 / 3.0;  // 1 + I/(mL²) with I = mL²/3 about the centre
    const double mass = cart_mass + pole_mass;
    const Scalar sine = sin(x[kPoleAngle]);
    const Scalar cosine = cos(x[kPoleAngle]);
    const Scalar centrifugal =
        (pole_mass * pole_half_length / mass) * (x[kAngularVelocity] * x[kAngularVelocity]) * sine;
    Scalar push = force;
    if (cart_damping != 0.0) push = push - cart_damping * x[kVelocity];
    const Scalar share = (1.0 / mass) * push + centrifugal;
    const Scalar inertia =
        pole_half_length * (kUniformPole - (pole_mass / mass) * (cosine * cosine));
    Scalar moment = gravity * sine - share * cosine;  // over m L
    if (pole_damping != 0.0) {
      moment = moment - (pole_damping / (pole_mass * pole_half_length)) * x[kAngularVelocity];
    }
    const Scalar angular = moment / inertia;
    slope[kPosition] = x[kVelocity];
    slope[kVelocity] = share - (pole_mass * pole_half_length / mass) * (angular * cosine);
    slope[kPoleAngle] = x[kAngularVelocity];
    slope[kAngularVelocity] = angular;
  }

  template <class Scalar>
  void step(const Scalar* x, const Scalar* u, Scalar* next) const {
    const auto slopes = [&](const Scalar* at, Scalar* slope) {
      derivative<Scalar>(at, u[kForce], slope);
    };
    runge_kutta_step<kStateDim>(slopes, x, time_step, next);
  }

  [[nodiscard]] SystemDescription description() const;

  /// Infinity: the derivatives grow with the angular velocity.
  [[nodiscard]] double lipschitz(const Eigen::Ref<const Eigen::MatrixXd>& gain) const;
};

/// Throws std::invalid_argument unless all parameters and time_step are finite and above 0, the two
/// dampings at least 0.
[[nodiscard]] std::unique_ptr<const Dynamics> make_cart_pole(const ParameterMap& parameters,
                                                             double time_step);

/// The entry in the table of systems.
[[nodiscard]] SystemEntry cart_pole_entry();

}  // namespace qsmpc::models
