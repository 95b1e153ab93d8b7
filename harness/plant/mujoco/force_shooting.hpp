// Forces in place of a kick: found for every period by simulating it again and again. Private to
// the MuJoCo plant.
#pragma once

#include <Eigen/Core>

#include "harness/plant/mujoco/simulation.hpp"

namespace qsmpc::harness {

/// A force that is held over the period cannot bring the covariance that the model plans with: it
/// moves a free body by half of what it changes the velocity by, and one that is held or rolls by
/// far less than its impulse suggests. Here springs pull the vehicle off its path, which tames the
/// friction of wheels that let go of the ground, and where their free ends go is searched with the
/// whole simulation as the function to be solved (Broyden's method, from sensitivities measured
/// once): servos, tyres and the springs' own compliance are all accounted for.
class ForceShooting {
 public:
  /// covariance: of the disturbances, state_dim x state_dim. Throws InputError where a state with a
  /// variance above 0 cannot be written.
  ForceShooting(Simulation& simulation, const models::SystemDescription& system,
                const Eigen::MatrixXd& covariance);

  /// What pulls the vehicle through the period that `simulation` is about to take (after
  /// start_period) as near as can be found to where `disturbance`, added at the end of the
  /// undisturbed period, would bring it. The simulation is left as it was; the result holds until
  /// the next call.
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
