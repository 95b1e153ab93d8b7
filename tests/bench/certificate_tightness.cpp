// How tight the certificates are: bound, truth and ratio at every stage, for the Dubins car of the
// reference thesis (N = 8, 100 points) and for the dynamic bicycle.
//
//   certificate_tightness [--paths N] [--all-stages]
//
// The truth is the rate of unsafe paths among N simulated ones (default 1,000,000). Exits with 1 if
// a certificate exceeds its limit: stage 1 within 1.3 × truth + 0.001, stage 8 within 3 × truth +
// 0.001 in open loop and 10 × truth + 0.001 in closed loop (bicycle: below 0.5 where the truth is
// below 0.01).
#include <iostream>
#include <random>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "controller/certification/certificate.hpp"
#include "controller/certification/error_budget.hpp"
#include "controller/planning/planner.hpp"
#include "models/constants.hpp"
#include "models/dynamics/dynamics.hpp"
#include "tests/support/simulated_truth.hpp"

namespace qsmpc::testing {
namespace {
constexpr double kTimeStep = 0.1;  // s
constexpr int kHorizon = 8;
constexpr std::uint64_t kSeed = 20240229;

struct Place {
  std::string name;
  controller::SafeSet safe_set;
};

controller::Box box(Eigen::Index dim, double x_lower, double x_upper, double y_lower,
                    double y_upper) {
  controller::Box result{.lower = Eigen::VectorXd::Constant(dim, -kInfinity),
                         .upper = Eigen::VectorXd::Constant(dim, kInfinity)};
  result.lower.head<2>() << x_lower, y_lower;
  result.upper.head<2>() << x_upper, y_upper;
  return result;
}

/// The three places at which the limits apply, at `margin` (m) from the vehicle's path: 1 for the
/// car. length: of the path (m).
std::vector<Place> places(Eigen::Index dim, double margin, double length) {
  const double far = 10.0 * length;
  controller::SafeSet walls{.bounds = box(dim, -margin, far, -margin, far), .obstacles = {}};
  controller::SafeSet corridor{.bounds = box(dim, -kInfinity, kInfinity, -margin, margin),
                               .obstacles = {}};
  controller::SafeSet beside = walls;
  beside.obstacles.push_back(box(dim, 0.7 * length, 1.5 * length, 0.9 * margin, 1.9 * margin));
  return {{"box", walls}, {"corridor", corridor}, {"obstacle", beside}};
}

struct Vehicle {
  std::string name;
  std::unique_ptr<const models::Dynamics> dynamics;
  controller::PlannerSettings settings;  ///< without a safe set
  controller::Gaussian belief;
  Eigen::MatrixXd inputs;
  double margin = 1.0;   ///< m, of the places
  double length = 1.2;   ///< m, path length over the horizon
  bool planned = false;  ///< the planner's inputs for the place, instead of `inputs`
};

Vehicle dubins_car() {
  Vehicle car;
  car.name = "dubins";
  car.dynamics = models::make_dynamics("dubins", {{"speed", 1.5}}, kTimeStep);
  car.settings.noise_covariance = Eigen::Vector3d(0.01, 0.01, 0.001).asDiagonal();
  car.settings.cost = {.state = Eigen::Vector3d(60.0, 60.0, 1.0).asDiagonal(),
                       .input = Eigen::MatrixXd::Constant(1, 1, 2.0),
                       .terminal = Eigen::Vector3d(60.0, 60.0, 5.0).asDiagonal(),
                       .target = Eigen::Vector3d(11.0, 9.0, 0.0)};
  car.settings.bounds = {.lower = Eigen::VectorXd::Constant(1, -2.0),
                         .upper = Eigen::VectorXd::Constant(1, 2.0)};
  car.belief = {.mean = Eigen::Vector3d::Zero(), .covariance = 0.01 * Eigen::Matrix3d::Identity()};
  car.inputs = Eigen::MatrixXd::Constant(1, kHorizon, 0.3);
  return car;
}

/// variance: of every coordinate of the initial state.
Vehicle bicycle(double speed, double variance, double margin) {
  Vehicle vehicle;
  vehicle.name = fmt::format("bicycle at {} m/s, N(0, {} I)", speed, variance);
  vehicle.dynamics = models::make_dynamics("bicycle", {}, kTimeStep);
  Eigen::VectorXd noise(6);
  noise << 0.01, 0.01, 0.001, 0.01, 0.01, 0.001;
  Eigen::VectorXd weights(6);
  weights << 50.0, 180.0, 10.5, 92.5, 0.5, 0.5;
  Eigen::VectorXd start = Eigen::VectorXd::Zero(6);
  start[3] = speed;
  Eigen::VectorXd target = start;
  target[0] = speed * kTimeStep * kHorizon;
  vehicle.settings.noise_covariance = noise.asDiagonal();
  vehicle.settings.cost = {.state = weights.asDiagonal(),
                           .input = Eigen::Vector2d(100.0, 25000.0).asDiagonal(),
                           .terminal = (1.5 * weights).asDiagonal(),
                           .target = target};
  vehicle.settings.bounds = {.lower = Eigen::Vector2d(-5.0, -0.7853981633974483),
                             .upper = Eigen::Vector2d(2.0, 0.7853981633974483)};
  vehicle.belief = {.mean = start, .covariance = variance * Eigen::MatrixXd::Identity(6, 6)};
  vehicle.inputs = Eigen::MatrixXd::Zero(2, kHorizon);
  vehicle.inputs.row(1).setConstant(0.02);
  vehicle.length = speed * kTimeStep * kHorizon;
  vehicle.margin = margin;
  return vehicle;
}

double promise(bool is_car, bool closed_loop, std::size_t stage, double truth) {
  if (stage == 1) return is_car ? 1.3 * truth + 0.001 : 1.0;
  if (is_car) return (closed_loop ? 10.0 : 3.0) * truth + 0.001;
  return truth < 0.01 ? 0.5 : 1.0;
}

struct Options {
  int paths = 1000000;
  bool all_stages = false;
};

/// Prints one case; returns whether it meets its limits.
bool report(const Vehicle& vehicle, const Place& place, bool closed_loop, const Options& options) {
  controller::PlannerSettings settings = vehicle.settings;
  settings.horizon = kHorizon;
  settings.closed_loop = closed_loop;
  settings.safe_set = place.safe_set;
  controller::Planner planner(*vehicle.dynamics, settings);
  const controller::Plan& plan = vehicle.planned
                                     ? planner.plan(vehicle.belief)
                                     : planner.prescribe(vehicle.belief, vehicle.inputs);
  const controller::PredictedMotion motion = controller::motion_of(planner, vehicle.belief, plan);
  const std::vector<controller::StageBudget> budgets = controller::error_budget(motion);
  const std::vector<controller::StageCertificate> certificates = controller::certify(
      motion, settings.safe_set, budgets, controller::CertificateEffort::kEvery);
  std::mt19937_64 generator(kSeed);
  const UnsafeCounts counts = simulate(motion, settings.safe_set, options.paths, generator);
  bool kept = true;
  std::cout << fmt::format("\n{}, {}, {}\n", vehicle.name, place.name,
                           closed_loop ? "closed loop" : "open loop");
  std::cout << "stage     truth     bound   ratio  kind        C1        C2        C3        C4"
               "    thesis    W2<=\n";
  for (std::size_t k = 0; k < certificates.size(); ++k) {
    const controller::StageCertificate& stage = certificates[k];
    const double truth = static_cast<double>(counts.stages[k]) / options.paths;
    const bool promised = k == 0 || k + 1 == certificates.size();
    const bool holds = !promised || stage.value <= promise(vehicle.dynamics->unicycle().has_value(),
                                                           closed_loop, k + 1, truth);
    kept = kept && holds;
    if (!promised && !options.all_stages) continue;
    std::cout << fmt::format(
        "{:5} {:9.2e} {:9.2e} {:7.2f}  {:4} {:9.2e} {:9.2e} {:9.2e} {:9.2e} {:9.2e} {:7.3f}{}\n",
        k + 1, truth, stage.value, truth > 0.0 ? stage.value / truth : kInfinity, stage.kind,
        stage.of("c1"), stage.of("c2"), stage.of("c3"), stage.of("c4"), stage.of("thesis"),
        budgets[k + 1].total, holds ? "" : "  above the limit");
  }
  return kept;
}

/// Prints every case; returns whether all meet their limits.
bool report_all(const Options& options) {
  std::vector<Vehicle> vehicles;
  vehicles.push_back(dubins_car());
  vehicles.push_back(dubins_car());
  vehicles.back().name += ", inputs planned";
  vehicles.back().planned = true;
  vehicles.push_back(bicycle(5.0, 0.01, 1.4));
  vehicles.push_back(bicycle(5.0, 0.1, 3.2));
  vehicles.push_back(bicycle(10.0, 0.01, 2.4));
  bool kept = true;
  for (const Vehicle& vehicle : vehicles) {
    for (const Place& place :
         places(vehicle.dynamics->state_dim(), vehicle.margin, vehicle.length)) {
      for (const bool closed_loop : {false, true}) {
        kept = report(vehicle, place, closed_loop, options) && kept;
      }
    }
  }
  return kept;
}

}  // namespace
}  // namespace qsmpc::testing

int main(int argc, char** argv) {
  CLI::App app("Bound, truth and ratio of the certificates");
  qsmpc::testing::Options options;
  app.add_option("--paths", options.paths, "simulated paths for the truth")
      ->check(CLI::PositiveNumber);
  app.add_flag("--all-stages", options.all_stages,
               "print all stages, not only the first and the last");
  CLI11_PARSE(app, argc, argv);
  return qsmpc::testing::report_all(options) ? 0 : 1;
}
