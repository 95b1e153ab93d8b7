// What is driven: something that holds a true state, takes an input for one control period and is
// then disturbed. The planner never sees a plant, only the states that it shows at the end of a
// period.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "models/constants.hpp"

#pragma GCC visibility push(default)

namespace qsmpc::harness {

/// Where the vehicle was between two control instants, for drawing.
struct MotionSample {
  double time = 0.0;         ///< s since reset
  std::vector<double> qpos;  ///< generalised position of the MuJoCo model; empty without one
};

/// How a vehicle touched walls and obstacles that are solid in one control period.
struct PlantContact {
  /// N, the largest normal force between the vehicle and one of them, at one place; 0 where it
  /// touched none, not a number where none is solid.
  double force = kNotANumber;
  double time = kNotANumber;  ///< s since reset, when it first touched one in this period
};

/// What one control period brought.
struct PlantStep {
  Eigen::VectorXd state;             ///< true state after the disturbance, state_dim
  std::vector<MotionSample> motion;  ///< samples within the period, oldest first
  /// The states at the simulator's own steps within the period, the last one at its end and before
  /// the disturbance: state_dim x steps; empty without a simulator.
  Eigen::MatrixXd between{};
  PlantContact contact{};
  std::optional<std::string>
      fault;  ///< the simulator's own words when it broke; state is then the last good one
};

class Plant {
 public:
  virtual ~Plant() = default;

  /// Puts the plant at rest of its low-level loops at `state` (state_dim, finite) and time 0, and
  /// returns the first motion sample.
  virtual MotionSample reset(const Eigen::VectorXd& state) = 0;

  /// Where the obstacles that move are at the beginning and at the end of the next period, between
  /// which they go straight: offset x, y (m) from where they are written, and turn (rad), 3 x
  /// count. Before a period, and after `reset`; a plant in which nothing is solid takes no notice.
  virtual void move_obstacles(const Eigen::Matrix3Xd& begin, const Eigen::Matrix3Xd& end) {
    (void)begin;
    (void)end;
  }

  /// Holds `input` (input_dim) for one control period, then adds `disturbance` (state_dim) to the
  /// state. A fault of the simulator is returned, never thrown; after one, only `reset` helps.
  virtual PlantStep advance(const Eigen::VectorXd& input, const Eigen::VectorXd& disturbance) = 0;

  /// The true state now, state_dim.
  [[nodiscard]] virtual Eigen::VectorXd state() const = 0;

  /// How far (rad, 0 to π) the plant's freely moving bodies are tilted from how its file has them,
  /// the largest of them; 0 of a plant that cannot tip over.
  [[nodiscard]] virtual double tilt() const { return 0.0; }
};

}  // namespace qsmpc::harness

#pragma GCC visibility pop
