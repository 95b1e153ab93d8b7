// The dynamic bicycle (Eq. 5-4): a car on linear tyres at small steering angles, discretised by
// implicit Euler in the lateral speed and in the yaw rate, which keeps it stable down to standstill
// (Ge et al., "Numerically Stable Dynamic Bicycle Model for Discrete-time Control", 2021).
#pragma once

#include <cmath>
#include <memory>

#include <Eigen/Core>

#include "models/dynamics/dynamics.hpp"

namespace qsmpc::models {

struct Bicycle {
  static constexpr int kStateDim = 6;
  static constexpr int kInputDim = 2;
  enum State {
    kX = 0,
    kY = 1,
    kHeading = 2,
    kLongitudinalSpeed = 3,
    kLateralSpeed = 4,
    kYawRate = 5
  };
  enum Input { kAcceleration = 0, kSteeringAngle = 1 };

  double mass;                  ///< m, kg
  double yaw_inertia;           ///< I, kg m²
  double front_axle_distance;   ///< l_f, from the centre of gravity, m
  double rear_axle_distance;    ///< l_r, from the centre of gravity, m
  double front_tyre_stiffness;  ///< k_f, lateral force of the axle by its slip angle, N/rad, < 0
  double rear_tyre_stiffness;   ///< k_r, N/rad, < 0
  double time_step;             ///< T, s

  /// With the speeds v = v_x (along the car) and v_y (to its left), the yaw rate ω, the steering
  /// angle δ (to the left) and the axles' slip angles α_f = (v_y + l_f ω)/v − δ and
  /// α_r = (v_y − l_r ω)/v, the linear tyres give
  ///
  ///     m (v̇_y + v ω) = k_f α_f + k_r α_r,    I ω̇ = l_f k_f α_f − l_r k_r α_r.
  ///
  /// Taking v_y at the end of the period in the first, ω at the end in the second, everything else
  /// at its beginning, and solving for them is Eq. 5-4. With S = −T(k_f + k_r) ≥ 0,
  /// S' = −T(l_f² k_f + l_r² k_r) ≥ 0 and c = T(l_f k_f − l_r k_r), it is the same as
  ///
  ///     v_y⁺ = (1 − S/(mv + S)) (v_y − T v ω − T k_f δ/m) + c ω/(mv + S),
  ///     ω⁺ = (1 − S'/(Iv + S')) (ω − T l_f k_f δ/I) + c v_y/(Iv + S'),
  ///
  /// in which v occurs fewer times, which makes enclosures over boxes tighter. Its poles, v = −S/m
  /// and v = −S'/I, are at negative speeds; the tyre model holds at positive ones.
  template <class Scalar>
  void step(const Scalar* x, const Scalar* u, Scalar* next) const {
    using std::cos;
    using std::sin;
    const double axle_sum = -time_step * (front_tyre_stiffness + rear_tyre_stiffness);
    const double moment_sum =
        -time_step * (front_axle_distance * front_axle_distance * front_tyre_stiffness +
                      rear_axle_distance * rear_axle_distance * rear_tyre_stiffness);
    const double coupling = time_step * (front_axle_distance * front_tyre_stiffness -
                                         rear_axle_distance * rear_tyre_stiffness);
    const double lateral_kick = -time_step * front_tyre_stiffness / mass;
    const double yaw_kick = -time_step * front_axle_distance * front_tyre_stiffness / yaw_inertia;

    const Scalar& speed = x[kLongitudinalSpeed];
    const Scalar& lateral = x[kLateralSpeed];
    const Scalar& yaw_rate = x[kYawRate];
    const Scalar& steering = u[kSteeringAngle];
    const Scalar cosine = cos(x[kHeading]);
    const Scalar sine = sin(x[kHeading]);
    next[kX] = x[kX] + time_step * (speed * cosine - lateral * sine);
    next[kY] = x[kY] + time_step * (lateral * cosine + speed * sine);
    next[kHeading] = x[kHeading] + time_step * yaw_rate;
    next[kLongitudinalSpeed] = speed + time_step * u[kAcceleration];

    const Scalar by_force = 1.0 / (mass * speed + axle_sum);
    const Scalar by_moment = 1.0 / (yaw_inertia * speed + moment_sum);
    next[kLateralSpeed] = (1.0 - axle_sum * by_force) *
                              (lateral - time_step * (speed * yaw_rate) + lateral_kick * steering) +
                          (coupling * yaw_rate) * by_force;
    next[kYawRate] = (1.0 - moment_sum * by_moment) * (yaw_rate + yaw_kick * steering) +
                     (coupling * lateral) * by_moment;
  }

  [[nodiscard]] SystemDescription description() const;

  /// Infinity: the derivatives grow with the speeds, and have poles.
  [[nodiscard]] double lipschitz(const Eigen::Ref<const Eigen::MatrixXd>& gain) const;
};

/// Throws std::invalid_argument unless mass, inertia, distances and time_step are above 0 and the
/// stiffnesses below 0, all finite.
[[nodiscard]] std::unique_ptr<const Dynamics> make_bicycle(const ParameterMap& parameters,
                                                           double time_step);

/// The entry in the table of systems.
[[nodiscard]] SystemEntry bicycle_entry();

}  // namespace qsmpc::models
