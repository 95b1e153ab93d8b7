// The cost of each part of a control period, by number of points, horizon and system, with the
// best-fitting complexity.
//
//   ocp_stages [Google Benchmark's options, e.g. --benchmark_filter=dubins/18]
//
// Takes about a minute and a half. Names are PART/SYSTEM/HORIZON/POINTS. The problems are those of
// scripts/bench-ocp: the Dubins car among blocks and the bicycle, closed loop. `POINTS` represent
// the belief and are kept after every step. Parts: quantise (the belief, from scratch), predict
// (under a given policy, with new assignments), evaluate (cost and gradient at fixed assignments),
// compress (100 points per kept one, by the split tree), certify (error budget and certificates),
// plan (a whole plan, warm-started from the last one along the planned path, with the belief's
// quantiser at hand). A suffix names the propagator.
#include <map>
#include <memory>
#include <string>
#include <tuple>
#include <vector>

#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include "controller/certification/certificate.hpp"
#include "controller/certification/error_budget.hpp"
#include "controller/measure/compression/compression.hpp"
#include "controller/planning/cost/horizon_cost.hpp"
#include "controller/planning/planner.hpp"
#include "controller/prediction/propagator.hpp"
#include "harness/assembly/assembly.hpp"
#include "harness/scenario/scenario_file.hpp"

namespace qsmpc::testing {
namespace {

struct Case {
  std::string system;
  int horizon = 8;
  std::string propagator;
  int points = 100;
};

/// The problem of a case, and a plan for it.
class Problem {
 public:
  explicit Problem(const Case& wanted)
      : Problem(harness::load_scenario(wanted.system == "bicycle" ? "bicycle_obstacles"
                                                                  : QSMPC_SOURCE_DIR
                                           "/tests/bench/scenarios/dubins_blocks.yaml",
                                       {fmt::format("controller.horizon={}", wanted.horizon)}),
                wanted) {}

  [[nodiscard]] controller::GaussianQuantisation quantised() const {
    return controller::quantise(belief_, settings_.state_points);
  }
  [[nodiscard]] controller::Prediction predicted() {
    return controller::predict(*model_, *propagator_, plan_.belief.measure, plan_.policy);
  }
  [[nodiscard]] controller::HorizonCost horizon_cost() const {
    return {{.dynamics = *model_,
             .safe_set = settings_.safe_set,
             .cost = settings_.cost,
             .penalty = settings_.penalty,
             .noise_covariance = settings_.noise_covariance,
             .within_covariance = plan_.belief.within_covariance},
            plan_.prediction,
            plan_.policy};
  }
  [[nodiscard]] std::vector<controller::StageCertificate> certificates() const {
    const controller::PredictedMotion motion = controller::motion_of(planner_, belief_, plan_);
    return controller::certify(motion, settings_.safe_set, controller::error_budget(motion));
  }
  /// Plans from where the last plan leads to; restarts from the initial state now and then.
  [[nodiscard]] const controller::Plan& next_plan(benchmark::State& state) {
    if (step_++ == kStepsOfAWay) {
      state.PauseTiming();
      step_ = 1;
      planner_.reset();
      way_ = belief_;
      follow(planner_.plan(way_));
      state.ResumeTiming();
    }
    const controller::Plan& plan = planner_.plan(way_);
    follow(plan);
    return plan;
  }
  [[nodiscard]] const controller::Plan& plan() const { return plan_; }

 private:
  static constexpr int kStepsOfAWay = 30;

  Problem(const harness::Scenario& scenario, const Case& wanted)
      : model_(harness::model_of(scenario)),
        settings_(settings_of(scenario, wanted)),
        propagator_(controller::make_propagator(
            settings_.propagator, {.noise = {.mean = Eigen::VectorXd::Zero(model_->state_dim()),
                                             .covariance = settings_.noise_covariance},
                                   .noise_points = settings_.noise_points,
                                   .compressed_points = settings_.compressed_points})),
        planner_(*model_, settings_),
        belief_{.mean = scenario.initial_state.mean, .covariance = settings_.noise_covariance},
        way_(belief_),
        plan_(planner_.plan(belief_)) {
    planner_.prepare(belief_.covariance);
  }

  static controller::PlannerSettings settings_of(const harness::Scenario& scenario,
                                                 const Case& wanted) {
    controller::PlannerSettings settings = harness::planner_settings(scenario);
    settings.propagator = wanted.propagator;
    settings.state_points = wanted.points;
    settings.compressed_points = wanted.points;
    return settings;
  }
  void follow(const controller::Plan& plan) { way_.mean = plan.policy.states.col(1); }

  std::unique_ptr<const models::Dynamics> model_;
  controller::PlannerSettings settings_;
  std::unique_ptr<controller::Propagator> propagator_;
  controller::Planner planner_;
  controller::Gaussian belief_;
  controller::Gaussian way_;  // the belief to plan from next
  int step_ = 0;
  controller::Plan plan_;
};

/// Google Benchmark calls a function several times, so its data are created once and kept.
Problem& problem_of(const Case& wanted) {
  static std::map<std::tuple<std::string, int, std::string, int>, std::unique_ptr<Problem>> known;
  auto& problem = known[{wanted.system, wanted.horizon, wanted.propagator, wanted.points}];
  if (!problem) problem = std::make_unique<Problem>(wanted);
  return *problem;
}

void quantise_belief(benchmark::State& state, Problem& problem) {
  for (auto _ : state) benchmark::DoNotOptimize(problem.quantised());
}

void predict_stages(benchmark::State& state, Problem& problem) {
  for (auto _ : state) benchmark::DoNotOptimize(problem.predicted());
}

void evaluate_cost(benchmark::State& state, Problem& problem) {
  controller::HorizonCost cost = problem.horizon_cost();
  // Alternates between two points, so that nothing cached from the last one can be used.
  const Eigen::MatrixXd inputs = problem.plan().policy.inputs;
  const Eigen::MatrixXd other = 0.99 * inputs;
  Eigen::MatrixXd gradient(inputs.rows(), inputs.cols());
  benchmark::DoNotOptimize(cost.evaluate(other, gradient));  // touches its memory
  bool first = true;
  for (auto _ : state) {
    benchmark::DoNotOptimize(cost.evaluate(first ? inputs : other, gradient));
    first = !first;
  }
}

void certify_stages(benchmark::State& state, Problem& problem) {
  for (auto _ : state) benchmark::DoNotOptimize(problem.certificates());
}

void plan_next(benchmark::State& state, Problem& problem) {
  for (auto _ : state) benchmark::DoNotOptimize(problem.next_plan(state).cost);
}

void compress_points(benchmark::State& state) {
  constexpr int kPointsEach = 100;
  constexpr int kDim = 3;
  const auto count = static_cast<int>(state.range(0));
  const controller::Gaussian law{.mean = Eigen::VectorXd::Zero(kDim),
                                 .covariance = Eigen::Vector3d(1.0, 0.7, 0.1).asDiagonal()};
  const controller::DiscreteMeasure measure =
      controller::quantise(law, kPointsEach * count).measure;
  for (auto _ : state) benchmark::DoNotOptimize(controller::compress(measure, count, 0));
  state.SetComplexityN(count);
}

using Part = void (*)(benchmark::State&, Problem&);

void add(const std::string& part, Part run, Case wanted, const std::vector<int>& points) {
  const std::string suffix = part == "quantise" ? "" : "_" + wanted.propagator;
  const std::string name = fmt::format("{}{}/{}/{}", part, suffix, wanted.system, wanted.horizon);
  auto* registered = benchmark::RegisterBenchmark(name.c_str(), [=](benchmark::State& state) {
    Case own = wanted;
    own.points = static_cast<int>(state.range(0));
    run(state, problem_of(own));
    state.SetComplexityN(state.range(0));
  });
  registered->Unit(benchmark::kMillisecond);
  for (const int count : points) registered->Arg(count);
  if (points.size() > 2) registered->Complexity();
}

void add_all() {
  const std::vector<int> many = {100, 1000, 10000, 100000};
  const std::vector<int> some = {100, 300, 1000, 3000};
  const std::vector<int> few = {100, 300, 1000};
  for (const std::string system : {"dubins", "bicycle"}) {
    add("quantise", quantise_belief, {system, 8, "noise_free"}, many);
    for (const int horizon : {8, 18}) {
      add("predict", predict_stages, {system, horizon, "noise_free"}, many);
      add("predict", predict_stages, {system, horizon, "mixture"}, some);
      add("predict", predict_stages, {system, horizon, "compressed"}, few);
      add("evaluate", evaluate_cost, {system, horizon, "noise_free"}, many);
      add("evaluate", evaluate_cost, {system, horizon, "mixture"}, some);
      add("certify", certify_stages, {system, horizon, "noise_free"}, many);
      add("certify", certify_stages, {system, horizon, "mixture"}, some);
      add("plan", plan_next, {system, horizon, "noise_free"}, few);
      add("plan", plan_next, {system, horizon, "mixture"}, few);
      add("plan", plan_next, {system, horizon, "compressed"}, {100});
    }
  }
  benchmark::RegisterBenchmark("compress/dubins", compress_points)
      ->Arg(100)
      ->Arg(300)
      ->Arg(1000)
      ->Complexity()
      ->Unit(benchmark::kMillisecond);
}

}  // namespace
}  // namespace qsmpc::testing

int main(int argc, char** argv) {
  // A default that command-line options can override.
  std::string least_time = "--benchmark_min_time=0.1";
  std::vector<char*> arguments(argv, argv + argc);
  arguments.insert(arguments.begin() + 1, least_time.data());
  int count = argc + 1;
  arguments.push_back(nullptr);
  benchmark::Initialize(&count, arguments.data());
  if (benchmark::ReportUnrecognizedArguments(count, arguments.data())) return 1;
  qsmpc::testing::add_all();
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return 0;
}
