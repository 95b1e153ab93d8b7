// Times of a step, its pullback and a whole plan with user-defined systems, compared with the same
// systems built in: as a TemplatedDynamics, and the bicycle with its hand-written loops.
//
//   scripts/bench own_dynamics
#include <map>
#include <string>

#include <benchmark/benchmark.h>

#include "controller/planning/planner.hpp"
#include "tests/support/own_systems.hpp"

namespace qsmpc {
namespace {

constexpr double kPeriod = 0.1;  // s
constexpr Eigen::Index kParticles = 100;

const models::Dynamics& system_called(const std::string& name) {
  static std::map<std::string, std::unique_ptr<const models::Dynamics>> made;
  auto& dynamics = made[name];
  if (dynamics == nullptr) {
    const std::size_t slash = name.find("/built_in");
    dynamics = slash == std::string::npos ? testing::make_any_dynamics(name, kPeriod)
                                          : testing::make_built_in(name.substr(0, slash), kPeriod);
  }
  return *dynamics;
}

models::StateBatch states_of(const models::Dynamics& dynamics, Eigen::Index count) {
  models::StateBatch states = 0.3 * models::StateBatch::Random(dynamics.state_dim(), count);
  const int speed = dynamics.description().state_index("longitudinal_speed");
  if (speed >= 0) states.row(speed).array() += 5.0;
  return states;
}

void step_and_pullback(benchmark::State& state, const std::string& name) {
  const models::Dynamics& dynamics = system_called(name);
  const models::StateBatch states = states_of(dynamics, kParticles);
  const models::StateBatch inputs =
      0.3 * models::StateBatch::Random(dynamics.input_dim(), kParticles);
  const models::StateBatch adjoint = states;
  models::StateBatch next = states;
  models::StateBatch of_states = states;
  models::StateBatch of_inputs = inputs;
  for (auto _ : state) {
    dynamics.step(states, inputs, next);
    dynamics.pullback(states, inputs, adjoint, of_states, of_inputs);
    benchmark::DoNotOptimize(of_states.data());
  }
}

void plan(benchmark::State& state, const std::string& name) {
  const models::Dynamics& dynamics = system_called(name);
  const int dim = dynamics.state_dim();
  const int inputs = dynamics.input_dim();
  controller::PlannerSettings settings;
  settings.horizon = 8;
  settings.state_points = settings.noise_points = settings.compressed_points = kParticles;
  settings.max_evaluations = 40;
  settings.noise_covariance = 1e-4 * Eigen::MatrixXd::Identity(dim, dim);
  settings.cost = {.state = Eigen::MatrixXd::Identity(dim, dim),
                   .input = 0.1 * Eigen::MatrixXd::Identity(inputs, inputs),
                   .terminal = Eigen::MatrixXd::Identity(dim, dim),
                   .target = Eigen::VectorXd::Ones(dim)};
  settings.safe_set = controller::unbounded_safe_set(dim);
  settings.bounds = {.lower = dynamics.description().input_lower,
                     .upper = dynamics.description().input_upper};
  const controller::Gaussian belief{.mean = states_of(dynamics, 1).col(0),
                                    .covariance = 1e-3 * Eigen::MatrixXd::Identity(dim, dim)};
  for (auto _ : state) {
    controller::Planner planner(dynamics, settings);
    benchmark::DoNotOptimize(&planner.plan(belief));
  }
}

}  // namespace
}  // namespace qsmpc

int main(int argc, char** argv) {
  for (const std::string name : {"bicycle", "cart_pole", "lag_unicycle/built_in", "lag_unicycle",
                                 "lag_unicycle_by_equations", "planar_quadrotor/built_in",
                                 "planar_quadrotor", "planar_quadrotor_by_equations"}) {
    benchmark::RegisterBenchmark(("step_and_pullback/" + name).c_str(), qsmpc::step_and_pullback,
                                 name);
    benchmark::RegisterBenchmark(("plan/" + name).c_str(), qsmpc::plan, name)
        ->Unit(benchmark::kMillisecond);
  }
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
}
