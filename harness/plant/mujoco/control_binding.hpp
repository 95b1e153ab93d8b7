// A system's inputs as controls of a MuJoCo model's actuators, including the low-level loops that
// do not depend on the simulated state. Private to the MuJoCo plant.
#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "harness/mujoco/named_model.hpp"
#include "harness/scenario/plant_mapping.hpp"
#include "models/dynamics/dynamics.hpp"

namespace qsmpc::harness {

/// The value of a PlantConstant. Throws InputError on an unknown parameter.
[[nodiscard]] double constant_value(const PlantConstant& constant,
                                    const models::ParameterMap& parameters);

class ControlBinding {
 public:
  /// data: after mj_forward at the model's reference pose. Throws InputError on a name that the
  /// model does not have, a steered wheel that is not ahead of the fixed axle, and a speed that is
  /// not above 0.
  ControlBinding(const NamedModel& named, const mjData& data, const PlantMapping& mapping,
                 const models::SystemDescription& system, const models::ParameterMap& parameters);

  /// The controls (nu) that `input` (input_dim) requests.
  [[nodiscard]] Eigen::VectorXd targets(const Eigen::VectorXd& input) const;

  /// Moves the controls towards `targets`, within their rate limits for one time step.
  void follow(mjData& data, const Eigen::VectorXd& targets) const;

  /// A loop that holds a constant speed.
  struct SpeedHold {
    double speed;  ///< m/s
    int actuator;
    double command;  ///< rad/s
    int body;        ///< root body of the wheel
    /// Corrects the command, given the steady speed (m/s, > 0) that it produced: a loaded wheel
    /// rolls on slightly less than its radius, and the servo droops under rolling resistance.
    void calibrate(double steady_speed) { command *= speed / steady_speed; }
  };
  [[nodiscard]] std::vector<SpeedHold>& speed_holds() { return speed_holds_; }

 private:
  struct Term {
    Eigen::Index input;
    int actuator;
    double gain;
    double offset;
  };
  struct Constant {
    int actuator;
    double value;
  };
  struct SteeredWheel {
    int actuator;
    double forward;  ///< m from the fixed axle
    double left;     ///< m from the middle of the fixed axle
  };
  struct Ackermann {
    Eigen::Index input;
    double speed;      ///< m/s; 0 where the input is an angle
    double wheelbase;  ///< m
    std::vector<SteeredWheel> wheels;
  };

  void add(const NamedModel& named, const mjData& data, const AckermannLoop& loop,
           const models::SystemDescription& system, const models::ParameterMap& parameters);
  void add(const NamedModel& named, const SpeedHoldLoop& loop,
           const models::ParameterMap& parameters);

  const mjModel& model_;
  std::vector<Term> terms_;
  std::vector<Constant> constants_;
  std::vector<Ackermann> ackermann_;
  std::vector<SpeedHold> speed_holds_;
  Eigen::VectorXd most_change_;  // of each control per time step
};

/// Index of the input called `name`, which must exist.
[[nodiscard]] Eigen::Index input_index(const models::SystemDescription& system,
                                       const std::string& name);

}  // namespace qsmpc::harness
