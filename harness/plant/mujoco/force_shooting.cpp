#include "harness/plant/mujoco/force_shooting.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "harness/errors.hpp"
#include "harness/mujoco/mujoco_errors.hpp"
#include "models/linear_algebra.hpp"

namespace qsmpc::harness {
namespace {

// Tolerances relative to a state's standard deviation and, for a rate that is not a state, to the
// rate that covers the position's deviation in one period.
constexpr double kTolerance = 1e-2;
constexpr double kFreeRateTolerance = 0.1;
constexpr int kMostRuns = 25;
constexpr double kLeastDeviation = 1e-3;  // m or rad, where no noise is planned
constexpr double kShortestStep = 0.02;    // fraction of a full step towards the solution
constexpr int kMostDoublings = 40;
constexpr double kGivesWay = 0.25;  // of a deviation

}  // namespace

ForceShooting::ForceShooting(Simulation& simulation, const models::SystemDescription& system,
                             const Eigen::MatrixXd& covariance) {
  const StateBinding& binding = simulation.binding();
  for (Eigen::Index i = 0; i < covariance.rows(); ++i) {
    if (covariance(i, i) == 0.0 || binding.is_writable(i)) continue;
    throw InputError({.file = simulation.file(),
                      .key = "disturbance.covariance." + std::to_string(i),
                      .found = "noise in " + system.states[static_cast<std::size_t>(i)].name,
                      .expected = "0: this state can only be read from the model"});
  }
  if (binding.positions().empty()) {
    throw InputError({.file = simulation.file(),
                      .key = "disturbance.kind",
                      .found = "force",
                      .expected = "state: nothing in the model can be pushed"});
  }
  simulation.reset(Eigen::VectorXd::Zero(covariance.rows()));
  simulation.start_period(Eigen::VectorXd::Zero(static_cast<Eigen::Index>(system.inputs.size())));
  set_scales(simulation, covariance);
  measure_sensitivities(simulation);
}

void ForceShooting::set_scales(Simulation& simulation, const Eigen::MatrixXd& covariance) {
  const StateBinding& binding = simulation.binding();
  const double period = simulation.period_steps() * simulation.time_step();
  masses_ = simulation.apparent_masses();
  deviations_ = covariance.diagonal()(binding.positions()).cwiseSqrt().cwiseMax(kLeastDeviation);
  const Eigen::Index size = deviations_.size();
  Eigen::VectorXd rates = kFreeRateTolerance / kTolerance / period * deviations_;
  if (binding.has_velocity()) {
    const Eigen::MatrixXd rates_by_states = simulation.rates_by_velocities();
    const Eigen::MatrixXd planned = covariance(binding.velocities(), binding.velocities());
    rates = (rates_by_states * planned * rates_by_states.transpose())
                .diagonal()
                .cwiseSqrt()
                .cwiseMax(kLeastDeviation / period)
                .cwiseMin(rates);
  }
  tolerances_.resize(2 * size);
  tolerances_ << kTolerance * deviations_, kTolerance * rates;
  units_.resize(2 * size);
  units_ << deviations_, deviations_ / period;
}

/// Servos resist springs that would move a free body. The springs' end points are therefore moved
/// further, until the vehicle moves by a displacement comparable to that of the noise.
void ForceShooting::measure_sensitivities(Simulation& simulation) {
  const SimulationSnapshot start = simulation.snapshot();
  path_ = simulation.take_period();
  const Eigen::Index size = deviations_.size();
  const auto response = [&](Eigen::Index k) -> Eigen::VectorXd {
    const Eigen::VectorXd unit = Eigen::VectorXd::Unit(2 * size, k);
    return 0.5 * (after(simulation, start, unit) - after(simulation, start, -unit));
  };
  for (Eigen::Index k = 0; k < size; ++k) {
    for (int doubling = 0; doubling < kMostDoublings; ++doubling) {
      if (!(std::abs(response(k)[k]) < kGivesWay * deviations_[k])) break;
      units_[k] *= 2.0;
      units_[size + k] *= 2.0;
    }
  }
  sensitivities_.resize(2 * size, 2 * size);
  for (Eigen::Index k = 0; k < 2 * size; ++k) sensitivities_.col(k) = response(k);
  simulation.restore(start);
}

PeriodPull ForceShooting::pull(const Eigen::VectorXd& unknowns) const {
  const Eigen::Index size = deviations_.size();
  const Eigen::VectorXd ends = unknowns.cwiseProduct(units_);
  return {
      .path = &path_, .masses = masses_, .displacement = ends.head(size), .rate = ends.tail(size)};
}

Eigen::VectorXd ForceShooting::after(Simulation& simulation, const SimulationSnapshot& start,
                                     const Eigen::VectorXd& unknowns) const {
  simulation.restore(start);
  const double heading = simulation.heading();
  simulation.set_pull(pull(unknowns));
  try {
    for (int k = 0; k < simulation.period_steps(); ++k) simulation.step();
    return simulation.placement(heading);
  } catch (const MujocoError&) {
    // Forces that break the simulation are too large: the miss is infinite.
    return Eigen::VectorXd::Constant(tolerances_.size(), std::numeric_limits<double>::infinity());
  }
}

PeriodPull ForceShooting::solve(Simulation& simulation, const Eigen::VectorXd& disturbance) {
  const SimulationSnapshot start = simulation.snapshot();
  const double heading = simulation.heading();
  path_ = simulation.take_period();
  Eigen::VectorXd best = Eigen::VectorXd::Zero(tolerances_.size());
  Eigen::VectorXd reached = simulation.placement(heading);
  simulation.add(disturbance);
  const Eigen::VectorXd goal = simulation.placement(heading);
  const auto miss_of = [&](const Eigen::VectorXd& placement) {
    return (goal - placement).cwiseQuotient(tolerances_).cwiseAbs().maxCoeff();
  };
  Eigen::MatrixXd sensitivities = sensitivities_;
  double miss = miss_of(reached);
  double step = 1.0;
  for (int run = 0; run < kMostRuns && miss > 1.0 && step > kShortestStep; ++run) {
    const Eigen::VectorXd change =
        step * models::solve_fully_pivoted(sensitivities, goal - reached);
    if (!change.allFinite() || change.isZero(0.0)) break;
    const Eigen::VectorXd tried = after(simulation, start, best + change);
    // Broyden's update: makes the sensitivities consistent with the last step.
    const Eigen::VectorXd seen = tried - reached;
    if (seen.allFinite()) {
      sensitivities += (seen - sensitivities * change) * change.transpose() / change.squaredNorm();
    }
    const double tried_miss = miss_of(tried);
    if (tried_miss < miss) {
      best += change;
      reached = tried;
      miss = tried_miss;
      step = std::min(1.0, 2.0 * step);
    } else {
      step *= 0.5;
    }
  }
  simulation.restore(start);
  return pull(best);
}

}  // namespace qsmpc::harness
