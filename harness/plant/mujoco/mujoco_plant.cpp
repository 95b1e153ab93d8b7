#include "harness/plant/mujoco/mujoco_plant.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <fmt/format.h>

#include "harness/errors.hpp"
#include "harness/mujoco/mujoco_errors.hpp"
#include "harness/plant/mujoco/force_shooting.hpp"
#include "harness/plant/mujoco/simulation.hpp"
#include "models/motion/obstacle_poses.hpp"

namespace qsmpc::harness {
namespace {

constexpr double kSamplePeriod = 0.02;  // s; video frames between samples are interpolated

void require_size(const Eigen::VectorXd& vector, std::size_t size, const char* what) {
  if (static_cast<std::size_t>(vector.size()) == size) return;
  throw std::invalid_argument(
      fmt::format("MuJoCo plant: {} of size {}, expected {}", what, vector.size(), size));
}

std::unique_ptr<Simulation> make_simulation(const MujocoPlantSetup& setup) {
  const MujocoTrap trap;
  try {
    return std::make_unique<Simulation>(setup);
  } catch (const MujocoError& error) {
    throw SimulatorError({.file = setup.mjcf,
                          .found = fmt::format("{} while settling", error.what()),
                          .expected = "a vehicle that settles"});
  }
}

class MujocoPlant final : public Plant {
 public:
  explicit MujocoPlant(const MujocoPlantSetup& setup)
      : state_dim_(setup.system.states.size()),
        input_dim_(setup.system.inputs.size()),
        simulation_(make_simulation(setup)),
        sample_steps_(
            std::max(1, static_cast<int>(std::lround(kSamplePeriod / simulation_->time_step())))) {
    const MujocoTrap trap;
    if (setup.force_covariance.size() > 0) {
      shooting_.emplace(*simulation_, setup.system, setup.force_covariance);
    }
    simulation_->reset(Eigen::VectorXd::Zero(static_cast<Eigen::Index>(state_dim_)));
    // Only now: the vehicle settles at its position in the file, which may be inside an obstacle.
    simulation_->set_solid_standing(true);
  }

  MotionSample reset(const Eigen::VectorXd& state) override {
    require_size(state, state_dim_, "state");
    if (!state.allFinite()) {
      throw std::invalid_argument("MuJoCo plant: reset to a non-finite state");
    }
    const MujocoTrap trap;
    fault_.reset();
    try {
      simulation_->reset(state);
    } catch (const MujocoError& error) {
      throw SimulatorError({.file = simulation_->file(),
                            .found = fmt::format("{} when placed", error.what()),
                            .expected = "a state that MuJoCo can simulate"});
    }
    return sample();
  }

  void move_obstacles(const Eigen::Matrix3Xd& begin, const Eigen::Matrix3Xd& end) override {
    obstacles_ = begin;
    moved_obstacles_ = end;
    simulation_->place_obstacles(begin);
  }

  PlantStep advance(const Eigen::VectorXd& input, const Eigen::VectorXd& disturbance) override {
    require_size(input, input_dim_, "input");
    require_size(disturbance, state_dim_, "disturbance");
    PlantStep result;
    if (!fault_) {
      const MujocoTrap trap;
      try {
        take_period(input, disturbance, result);
      } catch (const MujocoError& error) {
        fault_ = fmt::format("{} at {:.3f} s", error.what(), simulation_->time());
      }
    }
    result.state = simulation_->state();
    result.fault = fault_;
    return result;
  }

  [[nodiscard]] Eigen::VectorXd state() const override { return simulation_->state(); }

  [[nodiscard]] double tilt() const override { return simulation_->tilt(); }

 private:
  [[nodiscard]] MotionSample sample() const {
    return {.time = simulation_->time(), .qpos = simulation_->qpos()};
  }

  void take_period(const Eigen::VectorXd& input, const Eigen::VectorXd& disturbance,
                   PlantStep& result) {
    if (!input.allFinite()) throw MujocoError("input that is not finite");
    if (!disturbance.allFinite()) throw MujocoError("disturbance that is not finite");
    simulation_->start_period(input);
    if (shooting_ && !disturbance.isZero(0.0)) {
      // The pull is computed for a vehicle that does not collide.
      simulation_->set_solid_standing(false);
      simulation_->set_pull(shooting_->solve(*simulation_, disturbance));
      simulation_->set_solid_standing(true);
    }
    take_steps(result);
    const bool kicked = !shooting_;
    simulation_->add(kicked ? disturbance
                            : Eigen::VectorXd(Eigen::VectorXd::Zero(disturbance.size())));
    note_contact(simulation_->time(), result.contact);
    result.motion.push_back(sample());
  }

  /// Takes the simulator steps of a period. If one fails, the results of those before are kept.
  void take_steps(PlantStep& result) {
    const int steps = simulation_->period_steps();
    result.between.resize(Eigen::Index(state_dim_), steps);
    int taken = 0;
    try {
      while (taken < steps) {
        const double time = simulation_->time();
        if (obstacles_.cols() > 0) {
          simulation_->place_obstacles(
              models::poses_between(obstacles_, moved_obstacles_, (taken + 1.0) / steps));
        }
        simulation_->step();
        note_contact(time, result.contact);
        result.between.col(taken) = simulation_->state();
        ++taken;
        if (taken % sample_steps_ == 0 || taken == steps) result.motion.push_back(sample());
      }
    } catch (const MujocoError&) {
      result.between.conservativeResize(Eigen::NoChange, taken);
      throw;
    }
  }

  /// Records the contact force; `time` is the time of a first contact.
  void note_contact(double time, PlantContact& contact) const {
    const double force = simulation_->contact_force();
    contact.force = std::fmax(contact.force, force);
    if (force > 0.0 && std::isnan(contact.time)) contact.time = time;
  }

  std::size_t state_dim_;
  std::size_t input_dim_;
  std::unique_ptr<Simulation> simulation_;
  std::optional<ForceShooting> shooting_;
  int sample_steps_;
  Eigen::Matrix3Xd obstacles_;        // of moving obstacles, at the beginning of the period
  Eigen::Matrix3Xd moved_obstacles_;  // the same at its end
  std::optional<std::string> fault_;
};

}  // namespace

std::unique_ptr<Plant> make_mujoco_plant(const MujocoPlantSetup& setup) {
  return std::make_unique<MujocoPlant>(setup);
}

}  // namespace qsmpc::harness
