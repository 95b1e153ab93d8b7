// The result of `qsmpc predict`: the plan from a scenario's initial belief, the measures along its
// horizon, their errors and certificates. No plant is involved.
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
  std::optional<Eigen::MatrixXd> inputs{};  ///< input_dim x horizon; without them, they are planned
  /// Its seed is ignored in favour of the scenario's. Without samples there is no simulation.
  MonteCarloOptions monte_carlo{};
  /// Names of controller::law_methods() to compare with the simulated paths, of which at least
  /// kKeptPaths are then needed.
  std::vector<std::string> methods{};
};

struct PredictionReport {
  Scenario scenario;
  models::SystemDescription system;  ///< of the scenario's model
  std::string scenario_text;         ///< the resolved scenario as YAML
  std::string version;
  bool inputs_given = false;
  std::string solver_status;  ///< of planned inputs; empty if they were given
  controller::Policy policy;
  controller::CostParts cost;
  controller::Prediction prediction;
  std::vector<controller::StageBudget> budgets;            ///< horizon + 1
  std::vector<controller::StageCertificate> certificates;  ///< stages 1 … horizon
  double horizon_bound = 1.0;  ///< of the probability of being unsafe at any of these stages
  std::optional<UnsafeCounts> monte_carlo;
  std::optional<LawComparison> laws;  ///< if methods were requested
  bool interrupted = false;           ///< the simulation or the comparison was abandoned
};

/// Plans for the initial belief of `scenario` over its horizon, or takes the given inputs with the
/// gains that belong to them; certifies the policy, simulates it if requested, and compares the
/// methods. Throws std::invalid_argument on given inputs of the wrong size or outside the bounds,
/// on unknown methods, and on methods with fewer than kKeptPaths paths.
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

/// Stages whose certificate is below the lower limit of the simulated rate. Such a certificate is
/// wrong with confidence 1 − kRateTail: the program has a bug.
[[nodiscard]] std::vector<int> contradicted_stages(const PredictionReport& report);

}  // namespace qsmpc::harness
