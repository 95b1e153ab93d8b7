// What `qsmpc predict` computes: the plan from a scenario's initial belief, the measures along its
// horizon, their error and their certificates. No plant is involved.
//
//   PredictionReport report = predict_scenario(load_scenario("dubins_obstacles"), {});
//   report.certificates[0].value;   // bound of P(unsafe) at stage 1
//   write_prediction(report, "out/prediction");
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "controller/certification/certificate.hpp"
#include "controller/certification/error_budget.hpp"
#include "controller/planning/cost/horizon_cost.hpp"
#include "controller/prediction/policy.hpp"
#include "controller/prediction/prediction.hpp"
#include "harness/prediction/law_comparison.hpp"
#include "harness/prediction/monte_carlo.hpp"
#include "harness/scenario/scenario.hpp"
#include "harness/statistics/binomial_interval.hpp"
#include "models/dynamics/dynamics.hpp"

namespace qsmpc::harness {

struct PredictionOptions {
  std::optional<Eigen::MatrixXd> inputs{};  ///< input_dim x horizon; else they are planned
  /// Its seed is not used: the scenario's is. No samples: no simulation.
  MonteCarloOptions monte_carlo{};
  /// Names of controller::law_methods() that are compared with the simulated paths, of which there
  /// are then at least kKeptPaths.
  std::vector<std::string> methods{};
};

struct PredictionReport {
  Scenario scenario;
  models::SystemDescription system;  ///< of the scenario's model
  std::string scenario_text;         ///< the resolved scenario as YAML
  std::string version;
  bool inputs_given = false;
  std::string solver_status;  ///< of planned inputs; empty where they were given
  controller::Policy policy;
  controller::CostParts cost;
  controller::Prediction prediction;
  std::vector<controller::StageBudget> budgets;            ///< horizon + 1
  std::vector<controller::StageCertificate> certificates;  ///< stages 1 … horizon
  double horizon_bound = 1.0;  ///< of being unsafe at any of these stages
  std::optional<UnsafeCounts> monte_carlo;
  std::optional<LawComparison> laws;  ///< where methods were asked for
  bool interrupted = false;           ///< the simulation or the comparison was given up
};

/// Plans for the initial belief of `scenario` over its horizon, or takes the given inputs with the
/// gains that belong to them; certifies the policy, simulates it if asked, and compares the
/// methods. Throws std::invalid_argument on given inputs of another size or outside the bounds, on
/// unknown methods, and on methods with less paths than kKeptPaths.
[[nodiscard]] PredictionReport predict_scenario(const Scenario& scenario,
                                                const PredictionOptions& options);

/// Probability with which either limit of a simulated rate is wrong.
inline constexpr double kRateTail = 1e-6;

/// A simulated rate with its Clopper–Pearson limits, each of confidence 1 − kRateTail.
struct SimulatedRate {
  double rate = 0.0;
  RateInterval limits;
};

[[nodiscard]] SimulatedRate simulated_rate(std::int64_t events, std::int64_t samples);

/// Stages whose certificate is below the lower limit of the simulated rate. If there is one, the
/// certificate is wrong, but for a chance of kRateTail: the program has a bug.
[[nodiscard]] std::vector<int> contradicted_stages(const PredictionReport& report);

}  // namespace qsmpc::harness
