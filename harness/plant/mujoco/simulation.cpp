#include "harness/plant/mujoco/simulation.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <variant>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <fmt/format.h>

#include "harness/errors.hpp"
#include "harness/mujoco/mujoco_errors.hpp"
#include "harness/plant/mujoco/drawn_geoms.hpp"
#include "harness/threads/interruption.hpp"
#include "models/constants.hpp"
#include "models/linear_algebra.hpp"

namespace qsmpc::harness {
namespace {

// Tyres and contacts need a few thousand at most; with more, a drive would hardly end.
constexpr int kMostPeriodSteps = 20'000;
// Product of the springs' angular frequency and the time step: explicit springs are stable below 2.
constexpr double kPullRate = 0.25;

std::vector<double> copied(const double* values, int count) { return {values, values + count}; }

int first_bad(const double* values, int count) {
  const auto is_bad = [](double value) { return !(std::abs(value) < mjMAXVAL); };
  return static_cast<int>(std::find_if(values, values + count, is_bad) - values);
}

/// The number of steps of size `step` in `duration`. Throws InputError unless it is whole and not
/// too large.
int whole_steps(const std::string& file, double step, double duration) {
  const double ratio = std::round(duration / step);
  if (ratio > kMostPeriodSteps) {
    throw InputError(
        {.file = file,
         .key = "option timestep",
         .found = fmt::format("{} s, {:.4g} steps in a control period", step, ratio),
         .expected = fmt::format("at most {} steps in a control period of {} s: at least {:.3g} s",
                                 kMostPeriodSteps, duration, duration / kMostPeriodSteps)});
  }
  // Decimal numbers such as 0.1 / 0.002 are off by a few rounding errors only.
  constexpr double kRelativeRounding = 1e-9;
  if (ratio >= 1.0 && std::abs(ratio * step - duration) <= kRelativeRounding * duration) {
    return static_cast<int>(ratio);
  }
  throw InputError({.file = file,
                    .key = "option timestep",
                    .found = fmt::format("{} s", step),
                    .expected = fmt::format("a divisor of the control period {} s", duration)});
}

}  // namespace

Simulation::Simulation(const MujocoPlantSetup& setup) : Simulation(setup, load_vehicle(setup)) {}

Simulation::Simulation(const MujocoPlantSetup& setup, LoadedVehicle loaded)
    : file_(setup.mjcf),
      system_(setup.system),
      model_(std::move(loaded.model)),
      data_([&] {
        mjData* data = mj_makeData(model_.get());
        mj_forward(model_.get(), data);
        return data;
      }()),
      states_({.model = *model_, .file = file_}, *data_, loaded.mapping, system_),
      controls_({.model = *model_, .file = file_}, *data_, loaded.mapping, system_,
                setup.parameters),
      period_steps_(whole_steps(file_, model_->opt.timestep, setup.control_period)),
      delay_steps_(std::lround(loaded.mapping.input_delay / model_->opt.timestep)),
      state_(Eigen::VectorXd::Zero(static_cast<Eigen::Index>(system_.states.size()))),
      active_input_(Eigen::VectorXd::Zero(static_cast<Eigen::Index>(system_.inputs.size()))) {
  const NamedModel named{.model = *model_, .file = file_};
  for (const PlantLoop& loop : loaded.mapping.loops) {
    if (const auto* axles = std::get_if<AxleForces>(&loop)) {
      axles_.emplace_back(named, *axles, system_).scale_friction(setup.variation.friction);
    } else if (const auto* tyres = std::get_if<TyreForces>(&loop)) {
      tyres_.emplace_back(named, *tyres).scale_friction(setup.variation.friction);
    } else if (const auto* feedback = std::get_if<FeedbackLoop>(&loop)) {
      feedbacks_.emplace_back(named, *data_, *feedback, system_, setup.parameters);
    } else if (const auto* gait = std::get_if<GaitLoop>(&loop)) {
      gaits_.emplace_back(named, *gait, system_, loaded.mapping.settling);
    }
  }
  if (model_->opt.integrator == mjINT_RK4 && !(axles_.empty() && tyres_.empty())) {
    throw InputError({.file = file_,
                      .key = "option integrator",
                      .found = "RK4",
                      .expected = "Euler or implicit, because the plant computes the tyre forces"});
  }
  for (const std::string& name : loaded.mapping.rolling) {
    const int joint = scalar_joint(named, name);
    rolling_.push_back({.dof = model_->jnt_dofadr[joint], .radius = wheel_radius(named, joint)});
  }
  find_tipping_joints();
  if (setup.solid) {
    solid_.emplace(named, states_.carrier());
  } else {
    leave_out_drawn_geoms(*model_);
  }
  settle(loaded.mapping.settling);
}

void Simulation::reset(const Eigen::VectorXd& state) {
  restore(settled_);
  mj_forward(model_.get(), data_.get());
  const int body = states_.carrier();
  const double before = states_.has_velocity() ? forward_speed(body) : 0.0;
  Eigen::VectorXd change = state - states_.read(*data_, state);
  for (Eigen::Index i = 0; i < change.size(); ++i) {
    if (!states_.is_writable(i)) change[i] = 0.0;
  }
  states_.add(*data_, change);
  if (states_.has_velocity() && !rolling_.empty()) {
    const double faster = forward_speed(body) - before;
    for (const RollingWheel& wheel : rolling_) data_->qvel[wheel.dof] += faster / wheel.radius;
    mj_forward(model_.get(), data_.get());
  }
  for (TyreForceBinding& tyres : tyres_) tyres.weigh(*data_);
  check();
  state_ = states_.read(*data_, state);
  for (Eigen::Index i = 0; i < change.size(); ++i) {
    if (states_.is_writable(i)) state_[i] = state[i];
  }
  steps_ = 0;
  inputs_.clear();
  first_period_ = 0;
  active_period_ = -2;
  pull_ = {};
}

void Simulation::start_period(const Eigen::VectorXd& input) {
  inputs_.push_back(input);
  const auto kept = static_cast<std::size_t>(delay_steps_ / period_steps_ + 2);
  while (inputs_.size() > kept) {
    inputs_.pop_front();
    ++first_period_;
  }
  pull_ = {};
}

void Simulation::set_pull(PeriodPull pull) {
  pull_ = std::move(pull);
  pull_start_ = steps_;
  pull_axes_ = frame(heading());
}

PeriodPath Simulation::take_period() {
  PeriodPath path;
  const auto note = [&] {
    mj_forward(model_.get(), data_.get());
    const Eigen::Map<const Eigen::VectorXd> velocities(data_->qvel, model_->nv);
    path.positions.push_back(states_.read(*data_, state_)(states_.positions()));
    path.rates.emplace_back(states_.position_jacobian(*data_) * velocities);
  };
  for (int k = 0; k < period_steps_; ++k) {
    note();
    step();
  }
  return path;
}

double Simulation::heading() const { return system_.heading >= 0 ? state_[system_.heading] : 0.0; }

/// The input in effect is that of the period at the time `delay` ago; none before the first.
void Simulation::choose_input() {
  const long at = steps_ - delay_steps_;
  const long period = inputs_.empty() || at < 0 ? -1 : at / period_steps_;
  if (period == active_period_) return;
  active_period_ = period;
  active_input_.setZero();
  if (period >= 0) active_input_ = inputs_[static_cast<std::size_t>(period - first_period_)];
  targets_ = controls_.targets(active_input_);
}

void Simulation::apply_forces() {
  std::fill_n(data_->xfrc_applied, 6 * model_->nbody, 0.0);
  std::fill_n(data_->qfrc_applied, model_->nv, 0.0);
  for (const AxleForceBinding& axles : axles_) axles.apply(*data_, active_input_);
  for (const TyreForceBinding& tyres : tyres_) tyres.apply(*data_);
  if (pull_.path != nullptr) apply_pull();
}

/// A critically damped spring in each direction, as stiff as the time step allows, plus the force
/// that a free body would need to follow the springs' end points.
void Simulation::apply_pull() {
  const long k = steps_ - pull_start_;
  if (k < 0 || k >= period_steps_) return;
  const double period = period_steps_ * model_->opt.timestep;
  const double u = static_cast<double>(k) / period_steps_;
  const Eigen::VectorXd& end = pull_.displacement;
  const Eigen::VectorXd& rate = pull_.rate;
  const Eigen::VectorXd wanted = u * u * (3.0 - 2.0 * u) * end + period * u * u * (u - 1.0) * rate;
  const Eigen::VectorXd wanted_rate =
      6.0 * u * (1.0 - u) / period * end + u * (3.0 * u - 2.0) * rate;
  const Eigen::VectorXd wanted_acceleration =
      (6.0 - 12.0 * u) / (period * period) * end + (6.0 * u - 2.0) / period * rate;
  const Eigen::MatrixXd rows = states_.position_jacobian(*data_);
  const Eigen::Map<const Eigen::VectorXd> velocities(data_->qvel, model_->nv);
  const auto at = static_cast<std::size_t>(k);
  const Eigen::VectorXd moved =
      states_.read(*data_, state_)(states_.positions()) - pull_.path->positions[at];
  const Eigen::VectorXd faster = rows * velocities - pull_.path->rates[at];
  const double stiffness = kPullRate / model_->opt.timestep;  // rad/s
  const Eigen::VectorXd acceleration =
      stiffness * stiffness * (wanted - pull_axes_.transpose() * moved) +
      2.0 * stiffness * (wanted_rate - pull_axes_.transpose() * faster) + wanted_acceleration;
  Eigen::Map<Eigen::VectorXd> applied(data_->qfrc_applied, model_->nv);
  applied = rows.transpose() * (pull_axes_ * pull_.masses.cwiseProduct(acceleration));
  keep_level(applied);
}

/// Adds the moments that keep a vehicle on the ground level while it is pulled: forces of several
/// times its weight, all at one height, would overturn it, which a disturbance of its states must
/// not do.
void Simulation::keep_level(Eigen::Ref<Eigen::VectorXd> applied) {
  const int joint = model_->body_jntadr[states_.carrier()];
  if (states_.carrier() == 0 || joint < 0 || model_->jnt_type[joint] != mjJNT_FREE) return;
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  Rows jacobian(3, model_->nv);
  mj_jacBody(model_.get(), data_.get(), nullptr, jacobian.data(), states_.carrier());
  const Rows rows = jacobian.topRows(2);  // about the world's x and y axes
  Rows solved(2, model_->nv);
  mj_solveM(model_.get(), data_.get(), solved.data(), rows.data(), 2);
  const Eigen::Vector3d up = body_rotation(*data_, states_.carrier()).col(2);
  const Eigen::Vector2d tilt(up.y(), -up.x());  // up × z: the rotation axis that brings it upright
  const Eigen::Map<const Eigen::VectorXd> velocities(data_->qvel, model_->nv);
  const double stiffness = kPullRate / model_->opt.timestep;  // rad/s
  const Eigen::Vector2d acceleration =
      stiffness * stiffness * tilt - 2.0 * stiffness * (rows * velocities);
  const Eigen::Matrix2d inertia = (rows * solved.transpose()).inverse();
  applied += rows.transpose() * (inertia * acceleration);
}

/// Applies the low-level loops to the controls. data: with positions and velocities up to date.
void Simulation::control() {
  const bool has_feedback = !feedbacks_.empty() && feedback_mode_ != Feedback::kOff;
  if (gaits_.empty() && !has_feedback) {
    controls_.follow(*data_, targets_);
    return;
  }
  Eigen::VectorXd wanted = targets_;
  for (const GaitBinding& gait : gaits_) gait.add(time(), active_input_, wanted);
  if (has_feedback && feedback_mode_ == Feedback::kTest) wanted += test_controls_;
  if (has_feedback && feedback_mode_ == Feedback::kOn) {
    for (FeedbackBinding& feedback : feedbacks_) feedback.act(*data_, active_input_, wanted);
  }
  controls_.follow(*data_, wanted);
}

void Simulation::step() {
  check_interrupts();
  choose_input();
  // mj_step2 does not support Runge–Kutta. Only forces that depend on the state need the split
  // step, and the constructor rejects Runge–Kutta for those.
  if (model_->opt.integrator == mjINT_RK4) {
    if (!feedbacks_.empty()) {
      mj_fwdPosition(model_.get(), data_.get());
      mj_fwdVelocity(model_.get(), data_.get());
    }
    control();
    apply_forces();
    mj_step(model_.get(), data_.get());
  } else {
    mj_step1(model_.get(), data_.get());
    control();
    apply_forces();
    mj_step2(model_.get(), data_.get());
  }
  check();
  for (TyreForceBinding& tyres : tyres_) tyres.weigh(*data_);
  ++steps_;
  state_ = states_.read(*data_, state_);
}

/// After a bad position MuJoCo's next step would silently restart from the reference pose.
void Simulation::check() const {
  for (int kind = 0; kind < mjNWARNING; ++kind) {
    const mjWarningStat& warning = data_->warning[kind];
    if (warning.number > 0) throw MujocoError(mju_warningText(kind, warning.lastinfo));
  }
  const int position = first_bad(data_->qpos, model_->nq);
  if (position < model_->nq) throw MujocoError(mju_warningText(mjWARN_BADQPOS, position));
  const int velocity = first_bad(data_->qvel, model_->nv);
  if (velocity < model_->nv) throw MujocoError(mju_warningText(mjWARN_BADQVEL, velocity));
}

void Simulation::add(const Eigen::VectorXd& change) {
  mj_forward(model_.get(), data_.get());
  const Eigen::VectorXd next = states_.read(*data_, state_) + change;
  states_.add(*data_, change);
  check();
  for (TyreForceBinding& tyres : tyres_) tyres.weigh(*data_);
  state_ = states_.read(*data_, next);
}

void Simulation::place_obstacles(const Eigen::Matrix3Xd& poses) {
  obstacles_ = poses;
  if (solid_ && obstacles_.cols() > 0) solid_->place(obstacles_, *model_, *data_);
}

void Simulation::set_solid_standing(bool standing) {
  if (solid_) solid_->set_standing(*model_, standing);
}

double Simulation::contact_force() const {
  return solid_ ? solid_->largest_force(*model_, *data_) : kNotANumber;
}

std::vector<double> Simulation::qpos() const { return copied(data_->qpos, model_->nq); }

SimulationSnapshot Simulation::snapshot() const {
  std::vector<Eigen::VectorXd> loads;
  for (const TyreForceBinding& tyres : tyres_) loads.push_back(tyres.loads());
  std::vector<double> memories;
  for (const FeedbackBinding& feedback : feedbacks_) memories.push_back(feedback.memory());
  return {.qpos = copied(data_->qpos, model_->nq),
          .qvel = copied(data_->qvel, model_->nv),
          .act = copied(data_->act, model_->na),
          .qacc_warmstart = copied(data_->qacc_warmstart, model_->nv),
          .ctrl = copied(data_->ctrl, model_->nu),
          .tyre_loads = loads,
          .feedback_memories = memories,
          .state = state_,
          .steps = steps_};
}

void Simulation::restore(const SimulationSnapshot& snapshot) {
  mj_resetData(model_.get(), data_.get());  // also clears warnings, and a stack left by an error
  if (solid_ && obstacles_.cols() > 0) solid_->place(obstacles_, *model_, *data_);
  std::ranges::copy(snapshot.qpos, data_->qpos);
  std::ranges::copy(snapshot.qvel, data_->qvel);
  std::ranges::copy(snapshot.act, data_->act);
  std::ranges::copy(snapshot.qacc_warmstart, data_->qacc_warmstart);
  std::ranges::copy(snapshot.ctrl, data_->ctrl);
  for (std::size_t k = 0; k < tyres_.size(); ++k) tyres_[k].set_loads(snapshot.tyre_loads[k]);
  for (std::size_t k = 0; k < feedbacks_.size(); ++k) {
    feedbacks_[k].set_memory(snapshot.feedback_memories[k]);
  }
  state_ = snapshot.state;
  steps_ = snapshot.steps;
}

Eigen::MatrixXd Simulation::frame(double heading) const {
  const std::vector<Eigen::Index>& positions = states_.positions();
  const auto place = [&](int state) {
    return static_cast<Eigen::Index>(std::ranges::find(positions, state) - positions.begin());
  };
  const auto size = static_cast<Eigen::Index>(positions.size());
  Eigen::MatrixXd rotation = Eigen::MatrixXd::Identity(size, size);
  const Eigen::Index x = place(system_.position_x);
  const Eigen::Index y = place(system_.position_y);
  if (system_.heading < 0 || x >= size || y >= size) return rotation;
  const Eigen::Matrix2d turn = Eigen::Rotation2Dd(heading).toRotationMatrix();
  rotation(x, x) = turn(0, 0);
  rotation(x, y) = turn(0, 1);
  rotation(y, x) = turn(1, 0);
  rotation(y, y) = turn(1, 1);
  return rotation;
}

Eigen::VectorXd Simulation::placement(double heading) {
  mj_forward(model_.get(), data_.get());
  const Eigen::VectorXd state = states_.read(*data_, state_);
  const Eigen::MatrixXd to_vehicle = frame(heading).transpose();
  const Eigen::Map<const Eigen::VectorXd> velocities(data_->qvel, model_->nv);
  const auto size = static_cast<Eigen::Index>(states_.positions().size());
  Eigen::VectorXd result(2 * size);
  result.head(size) = to_vehicle * state(states_.positions());
  result.tail(size) = to_vehicle * (states_.position_jacobian(*data_) * velocities);
  return result;
}

Eigen::MatrixXd Simulation::rates_by_velocities() {
  mj_forward(model_.get(), data_.get());
  return states_.position_jacobian(*data_) *
         models::pseudo_inverse(states_.velocity_jacobian(*data_));
}

Eigen::VectorXd Simulation::apparent_masses() {
  mj_forward(model_.get(), data_.get());
  const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> rows =
      states_.position_jacobian(*data_);
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> solved(rows.rows(),
                                                                                rows.cols());
  mj_solveM(model_.get(), data_.get(), solved.data(), rows.data(), static_cast<int>(rows.rows()));
  return (rows * solved.transpose()).diagonal().cwiseInverse();
}

}  // namespace qsmpc::harness
