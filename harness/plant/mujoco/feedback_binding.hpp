// A feedback loop that holds a velocity by forces or torques. Private to the MuJoCo plant.
#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "harness/mujoco/named_model.hpp"
#include "harness/plant/mujoco/state_binding.hpp"
#include "harness/scenario/plant_mapping.hpp"
#include "models/dynamics/dynamics.hpp"

namespace qsmpc::harness {

/// With y the velocity, r its goal, T the time constant, and b the response, y's rate per unit of
/// the command u,
///
///     u = (r − 2y + z)/(bT),  ż = (r − y)/T,
///
/// so that y follows r as r/(Ts + 1) where y's rate is bu, and has no steady-state error where y is
/// damped as well. Each actuator receives its gain times u. z is frozen while u is saturated at an
/// actuator's limit (anti-windup).
class FeedbackBinding {
 public:
  /// data: after mj_forward at the model's reference pose. Throws InputError on a name that the
  /// model does not have and on a quantity that nothing can move.
  FeedbackBinding(const NamedModel& named, mjData& data, const FeedbackLoop& loop,
                  const models::SystemDescription& system, const models::ParameterMap& parameters);

  /// The velocity. data: with positions and velocities up to date.
  [[nodiscard]] double value(const mjData& data) const;
  /// The goal of the velocity under `input` (input_dim).
  [[nodiscard]] double goal(const Eigen::VectorXd& input) const;
  [[nodiscard]] double time_constant() const { return time_constant_; }

  [[nodiscard]] bool has_response() const { return response_ != 0.0; }
  void set_response(double response) { response_ = response; }
  /// The test command for measuring the response: a quarter of the actuators' limit.
  [[nodiscard]] double test_command() const;

  /// Adds `command` to the controls (nu).
  void add(double command, Eigen::VectorXd& controls) const;
  /// Adds the feedback command of the next time step. data: as for `value`.
  void act(const mjData& data, const Eigen::VectorXd& input, Eigen::VectorXd& controls);

  /// The loop's memory z.
  [[nodiscard]] double memory() const { return memory_; }
  void set_memory(double memory) { memory_ = memory; }

 private:
  struct Output {
    int actuator;
    double gain;
  };

  void limit_command(int actuator, double gain);

  const mjModel& model_;
  StateBinding quantity_;
  Eigen::Index input_ = -1;  // that sets the goal
  double goal_gain_ = 0.0;   // of that input; without one, the goal itself
  std::vector<Output> outputs_;
  double time_constant_;
  double response_;  // 0: not yet known
  double least_;     // of u
  double most_;
  double memory_ = 0.0;
};

}  // namespace qsmpc::harness
