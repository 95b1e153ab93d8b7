// Every system of the table and the user-defined ones, for tests that each system must pass.
#pragma once

#include <memory>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "models/dynamics/dynamics.hpp"
#include "tests/support/own_systems.hpp"

namespace qsmpc::testing {

inline constexpr double kTimeStep = 0.1;  // s

inline models::StateBatch random_batch(std::mt19937_64& generator, Eigen::Index rows,
                                       Eigen::Index cols, double scale) {
  std::uniform_real_distribution<double> uniform(-scale, scale);
  return models::StateBatch::NullaryExpr(rows, cols, [&] { return uniform(generator); });
}

class EverySystem : public ::testing::TestWithParam<std::string> {
 protected:
  EverySystem() : dynamics_(make_any_dynamics(GetParam(), kTimeStep)) {}

  [[nodiscard]] const models::Dynamics& dynamics() const { return *dynamics_; }
  /// Within ±4 of zero in every coordinate, except the car's speed, which is positive.
  [[nodiscard]] models::StateBatch states(Eigen::Index count) {
    models::StateBatch batch = random_batch(generator_, dynamics().state_dim(), count, 4.0);
    const int speed = dynamics().description().state_index("longitudinal_speed");
    if (speed >= 0) batch.row(speed) = 2.0 * batch.row(speed).array() + 10.0;
    return batch;
  }
  /// Within the system's own bounds.
  [[nodiscard]] models::StateBatch inputs(Eigen::Index count) {
    const models::SystemDescription& system = dynamics().description();
    models::StateBatch batch = random_batch(generator_, dynamics().input_dim(), count, 1.0);
    for (Eigen::Index axis = 0; axis < batch.rows(); ++axis) {
      const double middle = 0.5 * (system.input_upper[axis] + system.input_lower[axis]);
      const double half = 0.5 * (system.input_upper[axis] - system.input_lower[axis]);
      batch.row(axis) = batch.row(axis).array() * half + middle;
    }
    return batch;
  }
  [[nodiscard]] models::StateBatch step(const models::StateBatch& state,
                                        const models::StateBatch& input) const {
    models::StateBatch next =
        models::StateBatch::Constant(state.rows(), state.cols(), std::nan(""));
    dynamics().step(state, input, next);
    return next;
  }

  std::mt19937_64 generator_{20240607};

 private:
  std::unique_ptr<const models::Dynamics> dynamics_;
};

inline std::vector<std::string> system_names() {
  std::vector<std::string> names;
  for (const models::SystemEntry& entry : models::systems()) names.push_back(entry.name);
  names.insert(names.end(), own_system_names().begin(), own_system_names().end());
  return names;
}

}  // namespace qsmpc::testing
