// What `qsmpc compare` computes: how far plants are from the planner's model, in closed loop, in
// every period, and along the horizon of one plan, and what that does to the certificates.
//
//   const auto comparison = compare_plants(load_scenario("dubins_corridor"),
//                                          {.plants = {"analytic", "mujoco_car"}});
//   comparison->plants[1].one_step.rmse;       // by state
//   write_comparison(*comparison, {}, "out/comparison");
//
// docs/compare.md says what each number means.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "controller/certification/certificate.hpp"
#include "controller/measure/measures.hpp"
#include "controller/prediction/model_error.hpp"
#include "controller/prediction/policy.hpp"
#include "harness/mismatch/closed_loop.hpp"
#include "harness/mismatch/horizon_comparison.hpp"
#include "harness/mismatch/path_ensemble.hpp"
#include "harness/mismatch/residual_statistics.hpp"
#include "harness/scenario/scenario.hpp"
#include "harness/threads/shared_work.hpp"
#include "models/dynamics/dynamics.hpp"

namespace qsmpc::harness {

struct ComparisonOptions {
  std::vector<std::string> plants{};  ///< as `with_plant` takes them; empty: `default_plants`
  int episodes = 50;                  ///< ≥ 1, of each plant
  std::int64_t paths = 1000;          ///< ≥ 1, of each plant
  int threads = 0;                    ///< at most; 0: as many as the processor runs at once
  /// The plant whose model error is measured, one of `plants`; empty: none.
  std::string error_plant{};
  /// Called once all plants are made, before anything is simulated; what it throws passes through.
  std::function<void()> on_plants_ready{};
  /// Asked by several threads; true gives the work up.
  std::function<bool()> should_stop{};
  /// Told units of work done, their total and what is being done, by one thread at a time.
  SharedWork::Progress on_progress{};
};

/// A plant beside the planner's model.
struct PlantComparison {
  std::string name;
  std::vector<EpisodeResult> episodes{};
  ClosedLoop closed_loop{};
  ResidualStatistics one_step{};  ///< of the episodes
  PlantPaths paths{};             ///< under the plan
  std::vector<HorizonStage> horizon{};
  double speed = 0.0;  ///< simulated seconds a second on one core; wall clock, as nothing else is

  /// Stages whose certificate in force is below the lower limit of the observed rate.
  std::vector<int> exceeded_stages{};
};

struct Comparison {
  Scenario scenario;
  models::SystemDescription system;  ///< of the scenario's model
  std::string scenario_text;         ///< the resolved scenario as YAML
  std::string version;
  std::int64_t paths = 0;
  std::int64_t w2_paths = 0;                           ///< of them, how many enter W2
  controller::Policy policy;                           ///< of the plan from the initial belief
  std::vector<controller::DiscreteMeasure> particles;  ///< that it predicts, stages 0 … horizon
  std::vector<controller::Points> model_paths;         ///< stages 0 … horizon
  std::vector<W2Floor> floors;                         ///< stages 0 … horizon
  std::vector<controller::StageCertificate> certificates;  ///< for the model, stages 1 … horizon
  /// With the scenario's model error, where it has one: these are then in force.
  std::optional<std::vector<controller::StageCertificate>> with_error;
  std::vector<PlantComparison> plants;
  std::string error_plant;                               ///< where a model error was measured
  std::optional<controller::ModelError> measured_error;  ///< norms with their margin

  [[nodiscard]] const std::vector<controller::StageCertificate>& in_force() const {
    return with_error ? *with_error : certificates;
  }
};

/// "analytic", and "mujoco" where that is the scenario's own plant.
[[nodiscard]] std::vector<std::string> default_plants(const Scenario& scenario);

/// The stages of `horizon` whose certificate, at the same place in `certificates`, is below the
/// lower limit of the observed rate.
[[nodiscard]] std::vector<int> exceeded_stages(
    const std::vector<HorizonStage>& horizon,
    const std::vector<controller::StageCertificate>& certificates);

/// Compares the plants; those named twice are taken once. Nothing if `should_stop` said so before
/// the end. But for `speed`, the result depends on the scenario (its seed included) and the options
/// alone, not on the number of threads: a deadline of the planner is therefore left out. Throws
/// InputError on a plant that is not known or whose file is wrong, before anything is simulated.
[[nodiscard]] std::optional<Comparison> compare_plants(const Scenario& scenario,
                                                       const ComparisonOptions& options);

}  // namespace qsmpc::harness
