#include "harness/plant/analytic_plant.hpp"

#include <stdexcept>
#include <utility>

#include <fmt/format.h>

namespace qsmpc::harness {
namespace {

void require_size(const Eigen::VectorXd& vector, Eigen::Index size, const char* what) {
  if (vector.size() == size) return;
  throw std::invalid_argument(
      fmt::format("analytic plant: {} of size {}, expected {}", what, vector.size(), size));
}

class AnalyticPlant final : public Plant {
 public:
  AnalyticPlant(std::unique_ptr<const models::Dynamics> dynamics, double control_period)
      : dynamics_(std::move(dynamics)),
        control_period_(control_period),
        state_(Eigen::VectorXd::Zero(dynamics_->state_dim())) {}

  MotionSample reset(const Eigen::VectorXd& state) override {
    require_size(state, dynamics_->state_dim(), "state");
    if (!state.allFinite()) {
      throw std::invalid_argument("analytic plant: reset to a non-finite state");
    }
    state_ = state;
    periods_ = 0;
    fault_.reset();
    return {.time = 0.0, .qpos = {}};
  }

  PlantStep advance(const Eigen::VectorXd& input, const Eigen::VectorXd& disturbance) override {
    require_size(input, dynamics_->input_dim(), "input");
    require_size(disturbance, dynamics_->state_dim(), "disturbance");
    if (fault_) return {.state = state_, .motion = {}, .fault = fault_};
    models::StateBatch next(dynamics_->state_dim(), 1);
    dynamics_->step(models::StateBatch(state_), models::StateBatch(input), next);
    next.col(0) += disturbance;
    const double end = static_cast<double>(periods_ + 1) * control_period_;
    if (!next.allFinite()) {
      fault_ = fmt::format("state that is not finite at {:.3f} s", end);
      return {.state = state_, .motion = {}, .fault = fault_};
    }
    ++periods_;
    state_ = next.col(0);
    return {.state = state_, .motion = {{.time = end, .qpos = {}}}, .fault = std::nullopt};
  }

  [[nodiscard]] Eigen::VectorXd state() const override { return state_; }

 private:
  std::unique_ptr<const models::Dynamics> dynamics_;
  double control_period_;
  Eigen::VectorXd state_;
  long periods_ = 0;  // since reset
  std::optional<std::string> fault_;
};

}  // namespace

std::unique_ptr<Plant> make_analytic_plant(std::unique_ptr<const models::Dynamics> dynamics,
                                           double control_period) {
  return std::make_unique<AnalyticPlant>(std::move(dynamics), control_period);
}

}  // namespace qsmpc::harness
