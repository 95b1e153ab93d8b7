// The plant interface: a plant holds a true state, takes an input for one control period and is
// then disturbed. The planner never sees a plant, only the states that it reports at the ends of
// periods.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "models/constants.hpp"

#pragma GCC visibility push(default)

namespace qsmpc::harness {

/// The vehicle's pose between two control instants, for drawing.
struct MotionSample {
  double time = 0.0;         ///< s since reset
  std::vector<double> qpos;  ///< generalised position of the MuJoCo model; empty without one
};

/// Contact of a vehicle with solid walls and obstacles in one control period.
struct PlantContact {
  /// N, the largest normal force between the vehicle and one of them at a single contact; 0 without
  /// contact, not a number where none is solid.
  double force = kNotANumber;
  double time = kNotANumber;  ///< s since reset, of the first contact in this period
};

/// The result of one control period.
struct PlantStep {
  Eigen::VectorXd state;             ///< true state after the disturbance, state_dim
  std::vector<MotionSample> motion;  ///< samples within the period, oldest first
  /// The states after each simulator step within the period, the last one at its end and before the
  /// disturbance: state_dim x steps; empty without a simulator.
  Eigen::MatrixXd between{};
  PlantContact contact{};
  std::optional<std::string>
      fault;  ///< the simulator's error message if it failed; state is then the last good one
};

class Plant {
 public:
  virtual ~Plant() = default;

  /// Places the plant at `state` (state_dim, finite) with its low-level loops settled, at time 0,
  /// and returns the first motion sample.
  virtual MotionSample reset(const Eigen::VectorXd& state) = 0;

  /// Sets the poses of moving obstacles at the beginning and at the end of the next period; they
  /// move linearly in between. Each pose is the offset x, y (m) from the written position, and the
  /// turn (rad), 3 x count. Call before a period, and after `reset`; a plant without solids ignores
  /// it.
  virtual void move_obstacles(const Eigen::Matrix3Xd& begin, const Eigen::Matrix3Xd& end) {
    (void)begin;
    (void)end;
  }

  /// Holds `input` (input_dim) for one control period, then adds `disturbance` (state_dim) to the
  /// state. A fault of the simulator is returned, never thrown; afterwards only `reset` restores
  /// the plant.
  virtual PlantStep advance(const Eigen::VectorXd& input, const Eigen::VectorXd& disturbance) = 0;

  /// The true state now, state_dim.
  [[nodiscard]] virtual Eigen::VectorXd state() const = 0;

  /// The largest tilt (rad, 0 to π) of the plant's free bodies from their orientation in the file;
  /// 0 for a plant that cannot tip over.
  [[nodiscard]] virtual double tilt() const { return 0.0; }
};

}  // namespace qsmpc::harness

#pragma GCC visibility pop
