// The Dubins car in a room, with settings that tests change as needed, and a car that breaks.
#pragma once

#include <cmath>
#include <limits>
#include <memory>

#include <Eigen/Core>

#include "controller/planning/planner.hpp"
#include "models/dynamics/dynamics.hpp"

namespace qsmpc::testing {

inline std::unique_ptr<const models::Dynamics> dubins_car() {
  return models::make_dynamics("dubins", {{"speed", 1.5}}, 0.1);
}

inline controller::PlannerSettings dubins_settings() {
  controller::PlannerSettings settings;
  settings.horizon = 5;
  settings.state_points = 30;
  settings.noise_points = 20;
  settings.compressed_points = 30;
  settings.noise_covariance = Eigen::Vector3d(0.01, 0.01, 0.001).asDiagonal();
  settings.cost = {.state = Eigen::Vector3d(4.0, 4.0, 0.0).asDiagonal(),
                   .input = Eigen::MatrixXd::Constant(1, 1, 0.1),
                   .terminal = Eigen::Vector3d(4.0, 4.0, 0.0).asDiagonal(),
                   .target = Eigen::Vector3d(5.0, 5.0, 0.0)};
  settings.safe_set = controller::unbounded_safe_set(3);
  settings.safe_set.bounds.lower.head<2>().setConstant(-1.0);
  settings.safe_set.bounds.upper.head<2>().setConstant(12.0);
  settings.bounds = {.lower = Eigen::VectorXd::Constant(1, -2.0),
                     .upper = Eigen::VectorXd::Constant(1, 2.0)};
  return settings;
}

inline controller::Gaussian dubins_belief() {
  return {.mean = Eigen::Vector3d::Zero(), .covariance = 0.01 * Eigen::Matrix3d::Identity()};
}

/// A block ahead of the car, slightly off centre: passing below is a little shorter.
inline controller::PlannerSettings block_settings() {
  controller::PlannerSettings settings = dubins_settings();
  settings.horizon = 12;
  settings.cost.target << 6.0, 0.0, 0.0;
  settings.penalty.obstacle = 5000.0;
  settings.penalty.box = 5000.0;
  settings.safe_set.bounds.lower.head<2>().setConstant(-10.0);
  settings.safe_set.obstacles.push_back(controller::Box{.lower = Eigen::Vector3d(0.7, -0.3, -1e9),
                                                        .upper = Eigen::Vector3d(1.1, 0.35, 1e9)});
  return settings;
}

/// The Dubins car without a known Lipschitz constant; returns NaN when `broken`.
class FragileCar final : public models::Dynamics {
 public:
  bool broken = false;

  [[nodiscard]] const models::SystemDescription& description() const override {
    return car_->description();
  }
  void step(const BatchView& states, const BatchView& inputs, BatchOut next) const override {
    car_->step(states, inputs, next);
    if (broken) next.setConstant(std::nan(""));
  }
  void pullback(const BatchView& states, const BatchView& inputs, const BatchView& next_adjoint,
                BatchOut state_adjoint, BatchOut input_adjoint) const override {
    car_->pullback(states, inputs, next_adjoint, state_adjoint, input_adjoint);
  }
  void jacobians(const Eigen::Ref<const Eigen::VectorXd>& state,
                 const Eigen::Ref<const Eigen::VectorXd>& input,
                 Eigen::Ref<Eigen::MatrixXd> state_jacobian,
                 Eigen::Ref<Eigen::MatrixXd> input_jacobian) const override {
    car_->jacobians(state, input, state_jacobian, input_jacobian);
  }
  [[nodiscard]] double lipschitz(const Eigen::Ref<const Eigen::MatrixXd>&) const override {
    return std::numeric_limits<double>::infinity();
  }

 private:
  std::unique_ptr<const models::Dynamics> car_ = dubins_car();
};

}  // namespace qsmpc::testing
