// A periodic motion of actuators by which a vehicle with legs walks. Private to the MuJoCo plant.
#pragma once

#include <vector>

#include <Eigen/Core>

#include "harness/mujoco/named_model.hpp"
#include "harness/scenario/plant_mapping.hpp"
#include "models/dynamics/dynamics.hpp"

namespace qsmpc::harness {

class GaitBinding {
 public:
  /// Throws InputError on a name that the model does not have, on a cycle of fewer than ten of the
  /// simulator's steps, which would be no swing, and unless `settling` (s) is a whole number of the
  /// gait's cycles: otherwise the gait would jump when a settled vehicle is placed and its time
  /// starts again.
  GaitBinding(const NamedModel& named, const GaitLoop& loop,
              const models::SystemDescription& system, double settling);

  /// Adds the gait at `time` (s) under `input` (input_dim) to the controls (nu).
  void add(double time, const Eigen::VectorXd& input, Eigen::VectorXd& controls) const;

 private:
  struct Swing {
    int actuator;
    double amplitude;
    Eigen::Index input;  // that the amplitude depends on; -1: none
    double gain;         // of that input
    double phase;        // share of a cycle
  };

  double cycle_;  // s
  std::vector<Swing> swings_;
};

}  // namespace qsmpc::harness
