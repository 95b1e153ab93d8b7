// A third-party program: plans, certifies and drives with the installed library.
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <vector>

#include <Eigen/Core>
#include <qsmpc/controller.hpp>
#include <qsmpc/harness.hpp>
#include <qsmpc/version.hpp>

#if QSMPC_VERSION < 100
#error "an old version"
#endif

namespace {

using namespace qsmpc;

/// A plan by the controller alone, without a scenario, and its certificates.
bool plans_and_certifies() {
  const auto car = models::make_dynamics("dubins", {{"speed", 1.5}}, 0.1);
  controller::ControllerSettings settings;
  settings.problem.noise_covariance = Eigen::Vector3d(4e-4, 4e-4, 3e-4).asDiagonal();
  settings.problem.cost = {.state = Eigen::Vector3d(60.0, 60.0, 1.0).asDiagonal(),
                           .input = Eigen::MatrixXd::Constant(1, 1, 2.0),
                           .terminal = Eigen::Vector3d(60.0, 60.0, 5.0).asDiagonal(),
                           .target = Eigen::Vector3d(5.0, 3.0, 0.0)};
  settings.problem.safe_set = controller::unbounded_safe_set(3);
  settings.problem.safe_set.bounds.lower.head<2>().setConstant(-1.0);
  settings.problem.safe_set.bounds.upper.head<2>().setConstant(6.0);
  settings.problem.bounds = {.lower = car->description().input_lower,
                             .upper = car->description().input_upper};
  settings.problem.risk.plan = 0.02;
  const auto planner = controller::make_controller("quantised", *car, settings);
  const controller::Gaussian belief{.mean = Eigen::Vector3d::Zero(),
                                    .covariance = 1e-3 * Eigen::Matrix3d::Identity()};
  const Eigen::VectorXd observation = belief.mean;
  const controller::Situation situation{.belief = belief, .observation = observation};
  const controller::Decision& decision = planner->decide(situation);
  controller::DecisionMotion motions(*car, settings.problem);
  const controller::PredictedMotion motion = motions.of(situation, decision, belief);
  const std::vector<controller::StageCertificate> certificates =
      controller::certify(motion, settings.problem.safe_set, controller::error_budget(motion));
  std::printf("input %.3f, P(unsafe over the plan) <= %.2g\n", decision.input[0],
              controller::horizon_bound(certificates));
  return decision.input.allFinite() && certificates.size() == 8 && !decision.risk_exceeded &&
         controller::horizon_bound(certificates) <= 0.02;
}

/// An episode of a shipped scenario, written and read back.
bool drives() {
  const harness::Scenario scenario = harness::load_scenario(
      "dubins_obstacles", {"plant.kind=analytic", "limit.steps=20", "controller.horizon=6"});
  const harness::Trace trace = harness::run_episode(scenario, {.seed = 1});
  harness::write_trace("episode.h5", trace);
  const harness::Trace again = harness::read_trace("episode.h5");
  const harness::Summary summary = harness::summarise(harness::EpisodeView(again));
  std::printf("%s after %d steps\n", summary.outcome.c_str(), summary.steps);
  return summary.steps == 20 && again.steps.size() == trace.steps.size() &&
         std::filesystem::exists("episode.h5");
}

/// The library's exceptions are caught with their types.
bool refuses() {
  try {
    (void)harness::load_scenario("dubins_obstacles", {"controller.horizon=0"});
  } catch (const harness::InputError& error) {
    return error.where().key == "controller.horizon";
  }
  return false;
}

}  // namespace

int main() { return plans_and_certifies() && drives() && refuses() ? 0 : 1; }
