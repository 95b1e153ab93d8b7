// The shortest and plainest episode, for tests of its pictures.
#pragma once

#include <cmath>
#include <string>
#include <utility>

#include "harness/trace/episode_view.hpp"
#include "tests/support/described_trace.hpp"
#include "tests/unit/render/render_fixture.hpp"

namespace qsmpc::harness {

inline constexpr int kSteps = 6;
inline constexpr double kPeriod = 0.1;   // s
inline constexpr double kStride = 0.15;  // m driven in a period, along x
inline constexpr double kKick = 0.05;    // m, the disturbance along y after each period

inline Eigen::VectorXd state_at(int step) {
  return Eigen::Vector3d(kStride * step, kKick * step, 0.0);
}

inline Scenario straight_scenario() {
  Scenario scenario;
  scenario.name = "straight";
  scenario.model = {"dubins", {{"speed", 1.5}}};
  scenario.plant = {"analytic", render::kRedBox};
  scenario.time_step = kPeriod;
  scenario.safe_set = controller::unbounded_safe_set(3);
  scenario.safe_set.bounds.lower << -1.0, -1.0, -HUGE_VAL;
  scenario.safe_set.bounds.upper << 3.0, 2.0, HUGE_VAL;
  scenario.target = {Eigen::Vector3d(2.0, 1.0, 0.0), 0.3};
  scenario.controller.input_lower = Eigen::VectorXd::Constant(1, -2.0);
  scenario.controller.input_upper = Eigen::VectorXd::Constant(1, 2.0);
  scenario.controller.cost = {Eigen::Matrix3d::Identity(), Eigen::MatrixXd::Identity(1, 1),
                              Eigen::Matrix3d::Identity()};
  return scenario;
}

/// Drives straight ahead and is displaced sideways after each period.
inline Trace straight_trace() {
  Trace trace;
  trace.scenario = straight_scenario();
  for (int k = 0; k < kSteps; ++k) {
    StepRecord step;
    step.time = kPeriod * k;
    step.state = state_at(k);
    step.input = Eigen::VectorXd::Constant(1, 0.1 * k);
    step.disturbance = Eigen::Vector3d(0.0, kKick, 0.0);
    step.plan_states = Eigen::MatrixXd::Zero(3, 3);
    for (int stage = 0; stage < 3; ++stage) {
      step.plan_states.col(stage) = state_at(k) + Eigen::Vector3d(kStride * stage, 0.0, 0.0);
      step.particles.push_back(
          {models::StateBatch(step.plan_states.col(stage)), Eigen::VectorXd::Ones(1)});
    }
    step.certificates.resize(2);
    step.certificates[0].value = 1e-3 * (k + 1);
    step.certificates[1].value = 0.25;
    trace.steps.push_back(step);
  }
  trace.final_state = state_at(kSteps);
  trace.outcome = Outcome::kReached;
  return testing::described(std::move(trace));
}

/// The text of the row `name` on the head-up display.
inline std::string row_of(const render::Frame& frame, const std::string& name) {
  for (const render::HudRow& row : frame.hud) {
    if (row.name == name) {
      return row.value;
    }
  }
  return "no row " + name;
}

}  // namespace qsmpc::harness
