// The Dubins car: constant speed, steered by its yaw rate. Discretised by the classical Runge-Kutta
// method, with the yaw rate held over the period: the car then drives along an arc, whereas the
// explicit Euler method of dubins.hpp (Eq. 5-1) drives along the tangent.
#pragma once

#include <cmath>
#include <memory>

#include <Eigen/Core>

#include "models/dynamics/dynamics.hpp"
#include "models/dynamics/runge_kutta.hpp"

namespace qsmpc::models {

struct DubinsRk4 {
  static constexpr int kStateDim = 3;
  static constexpr int kInputDim = 1;
  enum State { kX = 0, kY = 1, kHeading = 2 };
  enum Input { kYawRate = 0 };

  double speed;      ///< v, m/s
  double time_step;  ///< T, s

  /// ẋ = v cos φ, ẏ = v sin φ, φ̇ = u.
  template <class Scalar>
  void derivative(const Scalar* x, const Scalar& yaw_rate, Scalar* slope) const {
    using std::cos;
    using std::sin;
    slope[kX] = speed * cos(x[kHeading]);
    slope[kY] = speed * sin(x[kHeading]);
    slope[kHeading] = yaw_rate;
  }

  /// The heading is exact, and the same at the two middle stages; the position follows by Simpson's
  /// rule, with e(φ) = (cos φ, sin φ):
  ///
  ///     (x, y)⁺ = (x, y) + (vT/6) (e(φ) + 4 e(φ + uT/2) + e(φ + uT)),    φ⁺ = φ + uT.
  ///
  /// It deviates from the arc by at most vT (uT)⁴/2880. The heading is never wrapped, see
  /// dubins.hpp.
  template <class Scalar>
  void step(const Scalar* x, const Scalar* u, Scalar* next) const {
    const auto slopes = [&](const Scalar* at, Scalar* slope) {
      derivative<Scalar>(at, u[kYawRate], slope);
    };
    runge_kutta_step<kStateDim>(slopes, x, time_step, next);
  }

  [[nodiscard]] SystemDescription description() const;

  /// See Dynamics::lipschitz; finite for every gain.
  [[nodiscard]] double lipschitz(const Eigen::Ref<const Eigen::MatrixXd>& gain) const;
};

/// Throws std::invalid_argument unless speed ≥ 0 (m/s) and time_step > 0 (s), both finite.
[[nodiscard]] std::unique_ptr<const Dynamics> make_dubins_rk4(const ParameterMap& parameters,
                                                              double time_step);

/// The entry in the table of systems.
[[nodiscard]] SystemEntry dubins_rk4_entry();

}  // namespace qsmpc::models
