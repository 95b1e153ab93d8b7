// The Dubins car (Eq. 5-1): constant speed, steered by its yaw rate, discretised by explicit Euler.
#pragma once

#include <cmath>
#include <memory>

#include <Eigen/Core>

#include "models/dynamics/dynamics.hpp"

namespace qsmpc::models {

struct Dubins {
  static constexpr int kStateDim = 3;
  static constexpr int kInputDim = 1;
  enum State { kX = 0, kY = 1, kHeading = 2 };
  enum Input { kYawRate = 0 };

  double speed;      ///< m/s
  double time_step;  ///< s

  /// x⁺ = x + vT cos φ, y⁺ = y + vT sin φ, φ⁺ = φ + uT. The heading is never wrapped: a jump by 2π
  /// would break the Lipschitz bound.
  template <class Scalar>
  void step(const Scalar* x, const Scalar* u, Scalar* next) const {
    using std::cos;
    using std::sin;
    next[kX] = x[kX] + speed * time_step * cos(x[kHeading]);
    next[kY] = x[kY] + speed * time_step * sin(x[kHeading]);
    next[kHeading] = x[kHeading] + time_step * u[kYawRate];
  }

  [[nodiscard]] SystemDescription description() const;

  /// See Dynamics::lipschitz; finite for every gain.
  [[nodiscard]] double lipschitz(const Eigen::Ref<const Eigen::MatrixXd>& gain) const;
};

/// Throws std::invalid_argument unless speed ≥ 0 (m/s) and time_step > 0 (s), both finite.
[[nodiscard]] std::unique_ptr<const Dynamics> make_dubins(const ParameterMap& parameters,
                                                          double time_step);

/// The entry in the table of systems.
[[nodiscard]] SystemEntry dubins_entry();

}  // namespace qsmpc::models
