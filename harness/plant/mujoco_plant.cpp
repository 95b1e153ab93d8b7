#include "harness/plant/mujoco_plant.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>
#include <mujoco/mujoco.h>

#include "harness/errors.hpp"
#include "harness/plant/mujoco_binding.hpp"
#include "harness/plant/mujoco_errors.hpp"
#include "harness/plant/mujoco_model.hpp"

namespace qsmpc {
namespace {

constexpr int kPoseDim = 3;
constexpr double kSamplePeriod = 0.02;  // s; pictures between samples are interpolated
// s of each of the two settling runs: the car drops onto its springs, which shows in its speed for
// 0.7 s.
constexpr double kSettlingTime = 1.0;
constexpr double kSettledSpeedError = 0.01;  // relative

struct MujocoDataDeleter {
  void operator()(mjData* data) const { mj_deleteData(data); }
};
using MujocoDataPtr = std::unique_ptr<mjData, MujocoDataDeleter>;

/// Everything that the next step depends on, warm start of the solver included.
struct Snapshot {
  std::vector<double> qpos;
  std::vector<double> qvel;
  std::vector<double> act;
  std::vector<double> qacc_warmstart;
};

std::vector<double> copied(const double* values, int count) { return {values, values + count}; }

Snapshot snapshot_of(const mjModel& model, const mjData& data) {
  return {.qpos = copied(data.qpos, model.nq),
          .qvel = copied(data.qvel, model.nv),
          .act = copied(data.act, model.na),
          .qacc_warmstart = copied(data.qacc_warmstart, model.nv)};
}

void restore(const Snapshot& snapshot, mjData& data) {
  std::ranges::copy(snapshot.qpos, data.qpos);
  std::ranges::copy(snapshot.qvel, data.qvel);
  std::ranges::copy(snapshot.act, data.act);
  std::ranges::copy(snapshot.qacc_warmstart, data.qacc_warmstart);
}

int first_bad(const double* values, int count) {
  const auto is_bad = [](double value) { return !(std::abs(value) < mjMAXVAL); };
  return static_cast<int>(std::find_if(values, values + count, is_bad) - values);
}

/// Throws MujocoError in MuJoCo's words if it has warned or is about to. A bad position would make
/// the next mj_step start anew from the reference pose and go on as if nothing had happened.
void throw_on_trouble(const mjModel& model, const mjData& data) {
  for (int kind = 0; kind < mjNWARNING; ++kind) {
    const mjWarningStat& warning = data.warning[kind];
    if (warning.number > 0) throw MujocoError(mju_warningText(kind, warning.lastinfo));
  }
  const int position = first_bad(data.qpos, model.nq);
  if (position < model.nq) throw MujocoError(mju_warningText(mjWARN_BADQPOS, position));
  const int velocity = first_bad(data.qvel, model.nv);
  if (velocity < model.nv) throw MujocoError(mju_warningText(mjWARN_BADQVEL, velocity));
}

int steps_per_period(const std::string& file, double timestep, double period) {
  const double ratio = std::round(period / timestep);
  // Decimal numbers such as 0.1 / 0.002 are off by some rounding errors only.
  constexpr double kRelativeRounding = 1e-9;
  if (ratio >= 1.0 && std::abs(ratio * timestep - period) <= kRelativeRounding * period) {
    return static_cast<int>(ratio);
  }
  throw InputError({.file = file,
                    .key = "option timestep",
                    .found = fmt::format("{} s", timestep),
                    .expected = fmt::format("a divisor of the control period {} s", period)});
}

void require_size(const Eigen::VectorXd& vector, Eigen::Index size, const char* what) {
  if (vector.size() == size) return;
  throw std::invalid_argument(
      fmt::format("MuJoCo plant: {} of size {}, expected {}", what, vector.size(), size));
}

class MujocoPlant final : public Plant {
 public:
  explicit MujocoPlant(const MujocoPlantSetup& setup);

  MotionSample reset(const Eigen::VectorXd& state) override;
  PlantStep advance(const Eigen::VectorXd& input, const Eigen::VectorXd& disturbance) override;
  [[nodiscard]] Eigen::VectorXd state() const override { return state_; }

 private:
  [[nodiscard]] double time() const { return static_cast<double>(steps_) * model_->opt.timestep; }
  [[nodiscard]] MotionSample sample() const;

  void bind(const MujocoMapping& mapping);
  void settle();
  void roll_straight(double duration);
  void step();
  void command(const Eigen::VectorXd& input);
  void take_period(const Eigen::VectorXd& input, const Eigen::VectorXd& disturbance,
                   std::vector<MotionSample>& motion);

  std::string file_;
  MujocoModelPtr model_;
  MujocoDataPtr data_;
  int input_dim_;
  int period_steps_;
  int sample_steps_;
  PoseBinding pose_;
  std::vector<LoopBinding> loops_;
  Snapshot settled_;
  Eigen::VectorXd state_ = Eigen::VectorXd::Zero(kPoseDim);  // the last good one
  long steps_ = 0;                                           // since reset
  std::optional<std::string> fault_;
};

MujocoPlant::MujocoPlant(const MujocoPlantSetup& setup)
    : file_(setup.mjcf),
      model_(load_mujoco_model(setup.mjcf)),
      input_dim_(setup.mapping.input_dim),
      period_steps_(steps_per_period(file_, model_->opt.timestep, setup.control_period)),
      sample_steps_(
          std::max(1, static_cast<int>(std::lround(kSamplePeriod / model_->opt.timestep)))),
      pose_({.model = *model_, .file = file_}, setup.mapping.pose) {
  const MujocoTrap trap;
  try {
    data_.reset(mj_makeData(model_.get()));
    bind(setup.mapping);
    settle();
  } catch (const MujocoError& error) {
    throw SimulatorError(
        {.file = file_,
         .found = fmt::format("{} (at {:.3f} s of settling)", error.what(), time()),
         .expected = "a vehicle that rolls straight at its speed"});
  }
  reset(Eigen::VectorXd::Zero(kPoseDim));
}

void MujocoPlant::bind(const MujocoMapping& mapping) {
  const NamedModel named{.model = *model_, .file = file_};
  mj_forward(model_.get(), data_.get());
  for (const LowLevelLoop& loop : mapping.loops) {
    if (const auto* steering = std::get_if<AckermannSteering>(&loop)) {
      loops_.emplace_back(SteeringBinding(named, *data_, pose_.body(), *steering));
    } else {
      loops_.emplace_back(SpeedHoldBinding(named, std::get<SpeedHold>(loop)));
    }
  }
}

// Two runs: the first shows at which speed the vehicle rolls steadily, and the second settles it
// with the command corrected for that.
void MujocoPlant::settle() {
  mj_resetData(model_.get(), data_.get());
  for (const LoopBinding& loop : loops_) {
    if (const auto* hold = std::get_if<SpeedHoldBinding>(&loop)) {
      pose_.set_speed(*data_, hold->speed());
      hold->spin_up(*data_);
    }
  }
  roll_straight(kSettlingTime);
  for (LoopBinding& loop : loops_) {
    auto* hold = std::get_if<SpeedHoldBinding>(&loop);
    if (hold == nullptr) continue;
    const double speed = pose_.speed(*data_);
    if (std::abs(speed - hold->speed()) > kSettledSpeedError * hold->speed()) {
      throw SimulatorError({.file = file_,
                            .found = fmt::format("{:.4g} m/s after settling", speed),
                            .expected = fmt::format("{:.4g} m/s within 1 %", hold->speed())});
    }
    hold->calibrate(speed);
  }
  roll_straight(kSettlingTime);
  settled_ = snapshot_of(*model_, *data_);
}

void MujocoPlant::roll_straight(double duration) {
  command(Eigen::VectorXd::Zero(input_dim_));
  const auto count = std::lround(duration / model_->opt.timestep);
  for (long k = 0; k < count; ++k) step();
}

void MujocoPlant::command(const Eigen::VectorXd& input) {
  for (const LoopBinding& loop : loops_) {
    if (const auto* steering = std::get_if<SteeringBinding>(&loop)) {
      steering->command(*data_, input);
    } else {
      std::get<SpeedHoldBinding>(loop).command(*data_);
    }
  }
}

void MujocoPlant::step() {
  mj_step(model_.get(), data_.get());
  throw_on_trouble(*model_, *data_);
  ++steps_;
  state_ = pose_.read(*data_, state_[pose_.heading()]);
}

MotionSample MujocoPlant::sample() const {
  return {.time = time(), .qpos = copied(data_->qpos, model_->nq)};
}

MotionSample MujocoPlant::reset(const Eigen::VectorXd& state) {
  require_size(state, kPoseDim, "state");
  if (!state.allFinite()) throw std::invalid_argument("MuJoCo plant: reset to a state not finite");
  fault_.reset();
  steps_ = 0;
  mj_resetData(model_.get(), data_.get());
  restore(settled_, *data_);
  pose_.place(*data_, state);
  state_ = state;
  return sample();
}

void MujocoPlant::take_period(const Eigen::VectorXd& input, const Eigen::VectorXd& disturbance,
                              std::vector<MotionSample>& motion) {
  if (!input.allFinite()) throw MujocoError("input that is not finite");
  if (!disturbance.allFinite()) throw MujocoError("disturbance that is not finite");
  command(input);
  for (int k = 1; k <= period_steps_; ++k) {
    step();
    if (k % sample_steps_ == 0 || k == period_steps_) motion.push_back(sample());
  }
  // The kick's heading is added to the unwrapped one: it may be more than half a turn.
  const double heading = state_[pose_.heading()] + disturbance[pose_.heading()];
  pose_.kick(*data_, disturbance);
  mj_forward(model_.get(), data_.get());
  throw_on_trouble(*model_, *data_);
  state_ = pose_.read(*data_, heading);
  motion.push_back(sample());
}

PlantStep MujocoPlant::advance(const Eigen::VectorXd& input, const Eigen::VectorXd& disturbance) {
  require_size(input, input_dim_, "input");
  require_size(disturbance, kPoseDim, "disturbance");
  PlantStep result;
  if (!fault_) {
    const MujocoTrap trap;
    try {
      take_period(input, disturbance, result.motion);
    } catch (const MujocoError& error) {
      fault_ = fmt::format("{} at {:.3f} s", error.what(), time());
    }
  }
  result.state = state_;
  result.fault = fault_;
  return result;
}

}  // namespace

std::unique_ptr<Plant> make_mujoco_plant(const MujocoPlantSetup& setup) {
  return std::make_unique<MujocoPlant>(setup);
}

}  // namespace qsmpc
