// Time of certification in one control period: quantising the belief, the error budget and the
// certificates, together and separately, for the Dubins car of the reference thesis (8 stages) in
// the default scenario's room, open and closed loop, with 100 and 1,000 points.
//
//   certificate_cost [Google Benchmark's options]
//
// Requirement: together below 1 ms with 100 points and below 10 ms with 1,000.
#include <memory>

#include <benchmark/benchmark.h>

#include "controller/certification/certificate.hpp"
#include "controller/certification/error_budget.hpp"
#include "controller/measure/quantisation/gaussian_quantiser.hpp"
#include "controller/planning/planner.hpp"
#include "models/dynamics/dynamics.hpp"

namespace qsmpc::testing {
namespace {

constexpr int kHorizon = 8;
constexpr double kYawRate = 0.3;  // rad/s

controller::SafeSet default_room() {
  controller::SafeSet room = controller::unbounded_safe_set(3);
  room.bounds.lower.head<2>().setConstant(-1.0);
  room.bounds.upper.head<2>().setConstant(12.0);
  const auto block = [](double x_lower, double x_upper, double y_lower, double y_upper) {
    controller::Box result = controller::unbounded_safe_set(3).bounds;
    result.lower.head<2>() << x_lower, y_lower;
    result.upper.head<2>() << x_upper, y_upper;
    return result;
  };
  room.obstacles = {block(2.0, 4.0, 2.0, 4.0), block(6.0, 8.0, 5.0, 8.0)};
  return room;
}

controller::PlannerSettings settings_for(int points, bool closed_loop) {
  controller::PlannerSettings settings;
  settings.horizon = kHorizon;
  settings.closed_loop = closed_loop;
  settings.state_points = points;
  settings.compressed_points = points;
  settings.noise_covariance = Eigen::Vector3d(0.01, 0.01, 0.001).asDiagonal();
  settings.cost = {.state = Eigen::Vector3d(60.0, 60.0, 1.0).asDiagonal(),
                   .input = Eigen::MatrixXd::Constant(1, 1, 2.0),
                   .terminal = Eigen::Vector3d(60.0, 60.0, 5.0).asDiagonal(),
                   .target = Eigen::Vector3d(11.0, 9.0, 0.0)};
  settings.safe_set = default_room();
  settings.bounds = {.lower = Eigen::VectorXd::Constant(1, -2.0),
                     .upper = Eigen::VectorXd::Constant(1, 2.0)};
  return settings;
}

/// A planned motion, with everything but the certificates prepared in advance.
class Motion {
 public:
  Motion(int points, bool closed_loop)
      : car_(models::make_dynamics("dubins", {{"speed", 1.5}}, 0.1)),
        planner_(*car_, settings_for(points, closed_loop)),
        belief_{.mean = Eigen::Vector3d::Zero(), .covariance = 0.01 * Eigen::Matrix3d::Identity()},
        plan_(planner_.prescribe(belief_, Eigen::MatrixXd::Constant(1, kHorizon, kYawRate))),
        motion_(controller::motion_of(planner_, belief_, plan_)),
        budgets_(controller::error_budget(motion_)) {}

  [[nodiscard]] controller::GaussianQuantisation quantised() const {
    return controller::quantise(belief_, planner_.settings().state_points);
  }
  [[nodiscard]] std::vector<controller::StageBudget> budgets() const {
    return controller::error_budget(motion_);
  }
  [[nodiscard]] std::vector<controller::StageCertificate> certificates(
      const std::vector<controller::StageBudget>& budgets) const {
    return controller::certify(motion_, planner_.settings().safe_set, budgets);
  }
  [[nodiscard]] const std::vector<controller::StageBudget>& known_budgets() const {
    return budgets_;
  }

 private:
  std::unique_ptr<const models::Dynamics> car_;
  controller::Planner planner_;
  controller::Gaussian belief_;
  const controller::Plan& plan_;
  controller::PredictedMotion motion_;
  std::vector<controller::StageBudget> budgets_;
};

Motion motion_for(const benchmark::State& state) {
  return {static_cast<int>(state.range(0)), state.range(1) != 0};
}

void quantise_belief(benchmark::State& state) {
  const Motion motion = motion_for(state);
  for (auto _ : state) benchmark::DoNotOptimize(motion.quantised());
}

void budget_errors(benchmark::State& state) {
  const Motion motion = motion_for(state);
  for (auto _ : state) benchmark::DoNotOptimize(motion.budgets());
}

void certify_stages(benchmark::State& state) {
  const Motion motion = motion_for(state);
  for (auto _ : state) benchmark::DoNotOptimize(motion.certificates(motion.known_budgets()));
}

void together(benchmark::State& state) {
  const Motion motion = motion_for(state);
  for (auto _ : state) {
    benchmark::DoNotOptimize(motion.quantised());
    benchmark::DoNotOptimize(motion.certificates(motion.budgets()));
  }
}

void settings_of(benchmark::internal::Benchmark* benchmark) {
  benchmark->ArgNames({"points", "closed"})->ArgsProduct({{100, 1000}, {0, 1}});
  benchmark->Unit(benchmark::kMillisecond);
}

BENCHMARK(quantise_belief)->Apply(settings_of);
BENCHMARK(budget_errors)->Apply(settings_of);
BENCHMARK(certify_stages)->Apply(settings_of);
BENCHMARK(together)->Apply(settings_of);

}  // namespace
}  // namespace qsmpc::testing

BENCHMARK_MAIN();
