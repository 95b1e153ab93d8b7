// Settling of a Simulation: on its springs, and to the speeds that its loops hold.
#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "harness/errors.hpp"
#include "harness/plant/mujoco/simulation.hpp"
#include "models/linear_algebra.hpp"

namespace qsmpc::harness {
namespace {

constexpr double kSettledSpeedError = 0.01;  // relative
constexpr double kFeedbackError = 0.05;      // relative; the loop continues to correct it

/// Whether the body consists of balls only, which have no upright orientation.
bool is_ball(const mjModel& model, int body) {
  const int first = model.body_geomadr[body];
  const int count = model.body_geomnum[body];
  for (int geom = first; geom < first + count; ++geom) {
    if (model.geom_type[geom] != mjGEOM_SPHERE) return false;
  }
  return count > 0;
}

}  // namespace

// With speed-holding loops, two runs: the first measures the vehicle's steady speed, and the second
// settles it with the command corrected for that.
void Simulation::settle(double duration) {
  mj_resetData(model_.get(), data_.get());
  mj_forward(model_.get(), data_.get());
  for (const auto& hold : controls_.speed_holds()) set_forward_speed(hold.body, hold.speed);
  mj_forward(model_.get(), data_.get());
  for (TyreForceBinding& tyres : tyres_) tyres.weigh(*data_);
  if (!feedbacks_.empty()) settle_with_feedback(duration);
  run_idle(duration);
  for (auto& hold : controls_.speed_holds()) {
    const double speed = forward_speed(hold.body);
    if (!(std::abs(speed - hold.speed) <= kSettledSpeedError * hold.speed)) {
      throw SimulatorError({.file = file_,
                            .found = fmt::format("{:.4g} m/s after settling", speed),
                            .expected = fmt::format("{:.4g} m/s within 1 %", hold.speed)});
    }
    hold.calibrate(speed);
  }
  if (!controls_.speed_holds().empty()) {
    active_period_ = -2;
    run_idle(duration);
  }
  settled_ = snapshot();
}

/// Starts at rest, where each loop with an unknown response is tested. Then all loops bring the
/// vehicle to their goals.
void Simulation::settle_with_feedback(double duration) {
  feedback_mode_ = Feedback::kOff;
  run_idle(duration);
  const SimulationSnapshot rest = snapshot();
  for (FeedbackBinding& feedback : feedbacks_) {
    if (!feedback.has_response()) feedback.set_response(measured_response(feedback));
    restore(rest);
  }
  active_period_ = -2;
  feedback_mode_ = Feedback::kOn;
  run_idle(duration);
  mj_forward(model_.get(), data_.get());
  for (const FeedbackBinding& feedback : feedbacks_) {
    const double goal = feedback.goal(active_input_);
    const double velocity = feedback.value(*data_);
    if (goal == 0.0 || std::abs(velocity - goal) <= kFeedbackError * std::abs(goal)) continue;
    throw SimulatorError(
        {.file = file_,
         .found = fmt::format("{:.4g} after settling with feedback", velocity),
         .expected = fmt::format("{:.4g} within 5 %, or a longer `settling`", goal)});
  }
}

/// Half the difference in velocity that the test command and its opposite cause within a time
/// constant, per unit of the command and of time.
double Simulation::measured_response(const FeedbackBinding& feedback) {
  constexpr double kNoResponse = 1e-9;
  const SimulationSnapshot rest = snapshot();
  const double command = feedback.test_command();
  const double step = model_->opt.timestep;
  const double time = std::max(1.0, std::round(feedback.time_constant() / step)) * step;
  std::array<double, 2> velocities{};
  feedback_mode_ = Feedback::kTest;
  for (const int side : {0, 1}) {
    restore(rest);
    test_controls_ = Eigen::VectorXd::Zero(model_->nu);
    feedback.add(side == 0 ? -command : command, test_controls_);
    run_idle(time);
    mj_forward(model_.get(), data_.get());
    velocities[side] = feedback.value(*data_);
  }
  feedback_mode_ = Feedback::kOff;
  const double response = 0.5 * (velocities[1] - velocities[0]) / (command * time);
  if (std::abs(response) > kNoResponse) return response;
  throw SimulatorError(
      {.file = file_,
       .found = fmt::format("a velocity that changes by {:.3g} under a control of "
                            "{:.3g}",
                            velocities[1] - velocities[0], command),
       .expected = "feedback-loop actuators that change the velocity that the loop holds"});
}

void Simulation::find_tipping_joints() {
  for (int joint = 0; joint < model_->njnt; ++joint) {
    if (model_->jnt_type[joint] == mjJNT_FREE && !is_ball(*model_, model_->jnt_bodyid[joint])) {
      tipping_.push_back(joint);
    }
  }
}

double Simulation::tilt() const {
  double largest = 0.0;
  for (const int joint : tipping_) {
    constexpr int kRotation = 3;  // after the position, in qpos
    const int place = model_->jnt_qposadr[joint] + kRotation;
    const auto rotation = [place](const mjtNum* qpos) {
      return Eigen::Quaterniond(qpos[place], qpos[place + 1], qpos[place + 2], qpos[place + 3])
          .normalized();
    };
    const Eigen::Vector3d up = rotation(model_->qpos0).conjugate() * Eigen::Vector3d::UnitZ();
    const double cosine = (rotation(data_->qpos) * up).z();
    largest = std::max(largest, std::acos(std::clamp(cosine, -1.0, 1.0)));
  }
  return largest;
}

void Simulation::run_idle(double duration) {
  const auto count = std::lround(duration / model_->opt.timestep);
  for (long k = 0; k < count; ++k) step();
}

double Simulation::forward_speed(int body) const {
  std::array<double, 6> motion{};
  mj_forward(model_.get(), data_.get());
  mj_objectVelocity(model_.get(), data_.get(), mjOBJ_XBODY, body, motion.data(), 0);
  const Eigen::Vector3d forward = body_rotation(*data_, body).col(0);
  const double level = std::hypot(forward.x(), forward.y());
  return level > 0.0 ? (forward.x() * motion[3] + forward.y() * motion[4]) / level : 0.0;
}

/// Sets the body's forward speed, and spins the wheels accordingly.
void Simulation::set_forward_speed(int body, double speed) {
  Eigen::Matrix<double, 3, Eigen::Dynamic, Eigen::RowMajor> jacobian(3, model_->nv);
  mj_jacBody(model_.get(), data_.get(), jacobian.data(), nullptr, body);
  const Eigen::Vector3d missing =
      (speed - forward_speed(body)) * body_rotation(*data_, body).col(0);
  Eigen::Map<Eigen::VectorXd> velocities(data_->qvel, model_->nv);
  velocities += models::smallest_solution(jacobian, missing);
  for (const RollingWheel& wheel : rolling_) data_->qvel[wheel.dof] = speed / wheel.radius;
}

}  // namespace qsmpc::harness
