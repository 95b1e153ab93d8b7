// Disturbance forces instead of a state jump, found in every period by repeated simulation. Private
// to the MuJoCo plant.
#pragma once

#include <Eigen/Core>

#include "harness/plant/mujoco/simulation.hpp"

namespace qsmpc::harness {

/// A force held constant over the period cannot produce the covariance that the model plans with:
/// it displaces a free body by only half of its change of velocity times the period, and a body
/// that is held or rolls by far less than its impulse suggests. Instead, springs pull the vehicle
/// off its path, which stabilises the friction of wheels that lose grip. The end points of the
/// springs are found by Broyden's method, with the whole simulation as the function to be solved
/// and sensitivities measured once: servos, tyres and the springs' own compliance are all accounted
/// for.
class ForceShooting {
 public:
  /// covariance: of the disturbances, state_dim x state_dim. Throws InputError where a state with a
  /// variance above 0 cannot be written.
  ForceShooting(Simulation& simulation, const models::SystemDescription& system,
                const Eigen::MatrixXd& covariance);

  /// The pull over the period that `simulation` is about to take (after start_period) that brings
  /// the vehicle as close as can be found to the state at the end of the undisturbed period plus
  /// `disturbance`. The simulation is left unchanged; the result is valid until the next call.
  [[nodiscard]] PeriodPull solve(Simulation& simulation, const Eigen::VectorXd& disturbance);

 private:
  [[nodiscard]] Eigen::VectorXd after(Simulation& simulation, const SimulationSnapshot& start,
                                      const Eigen::VectorXd& unknowns) const;
  [[nodiscard]] PeriodPull pull(const Eigen::VectorXd& unknowns) const;
  void set_scales(Simulation& simulation, const Eigen::MatrixXd& covariance);
  void measure_sensitivities(Simulation& simulation);

  PeriodPath path_;                // of the undisturbed period
  Eigen::VectorXd masses_;         // apparent, of each position
  Eigen::VectorXd units_;          // of the unknowns: displacements, then rates
  Eigen::VectorXd deviations_;     // of the displacements
  Eigen::VectorXd tolerances_;     // of positions, then rates
  Eigen::MatrixXd sensitivities_;  // of positions and rates to the unknowns
};

}  // namespace qsmpc::harness
