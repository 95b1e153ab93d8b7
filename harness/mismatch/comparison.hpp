// The computation of `qsmpc compare`: how far plants deviate from the planner's model, in closed
// loop, in every period and along the horizon of one plan, and what that means for the
// certificates.
//
//   const auto comparison = compare_plants(load_scenario("dubins_corridor"),
//                                          {.plants = {"analytic", "mujoco_car"}});
//   comparison->plants[1].one_step.rmse;       // by state
//   write_comparison(*comparison, {}, "out/comparison");
//
// docs/compare.md defines every number.
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
  std::vector<std::string> plants{};  ///< as for `with_plant`; empty: `default_plants`
  int episodes = 50;                  ///< ≥ 1, per plant
  std::int64_t paths = 1000;          ///< ≥ 1, per plant
  int threads = 0;                    ///< upper limit; 0: the processor's hardware threads
  /// The plant whose model error is measured, one of `plants`; empty: none.
  std::string error_plant{};
  /// Called once all plants are made, before any simulation; its exceptions propagate.
  std::function<void()> on_plants_ready{};
  /// Called by several threads; returning true aborts the comparison.
  std::function<bool()> should_stop{};
  /// Receives the completed and total units of work and the current task, from one thread at a
  /// time.
  SharedWork::Progress on_progress{};
};

/// A plant compared with the planner's model.
struct PlantComparison {
  std::string name;
  std::vector<EpisodeResult> episodes{};
  ClosedLoop closed_loop{};
  ResidualStatistics one_step{};  ///< of the episodes
  PlantPaths paths{};             ///< under the plan's policy
  std::vector<HorizonStage> horizon{};
  double speed = 0.0;  ///< simulated seconds per second on one core; wall clock, unlike all else

  /// Stages whose certificate in force is below the lower limit of the observed rate.
  std::vector<int> exceeded_stages{};
};

struct Comparison {
  Scenario scenario;
  models::SystemDescription system;  ///< of the scenario's model
  std::string scenario_text;         ///< the resolved scenario as YAML
  std::string version;
  std::int64_t paths = 0;
  std::int64_t w2_paths = 0;                               ///< number of the paths that enter W2
  controller::Policy policy;                               ///< of the plan from the initial belief
  std::vector<controller::DiscreteMeasure> particles;      ///< predicted, stages 0 … horizon
  std::vector<controller::Points> model_paths;             ///< stages 0 … horizon
  std::vector<W2Floor> floors;                             ///< stages 0 … horizon
  std::vector<controller::StageCertificate> certificates;  ///< for the model, stages 1 … horizon
  /// The same with the scenario's model error, where it has one; these are then in force.
  std::optional<std::vector<controller::StageCertificate>> with_error;
  std::vector<PlantComparison> plants;
  std::string error_plant;                               ///< whose model error was measured
  std::optional<controller::ModelError> measured_error;  ///< norms include their margin

  [[nodiscard]] const std::vector<controller::StageCertificate>& in_force() const {
    return with_error ? *with_error : certificates;
  }
};

/// "analytic", and "mujoco" if that is the scenario's own plant.
[[nodiscard]] std::vector<std::string> default_plants(const Scenario& scenario);

/// The stages of `horizon` whose certificate, the corresponding element of `certificates`, is below
/// the lower limit of the observed rate.
[[nodiscard]] std::vector<int> exceeded_stages(
    const std::vector<HorizonStage>& horizon,
    const std::vector<controller::StageCertificate>& certificates);

/// Compares the plants; duplicate names are ignored. Nothing if `should_stop` returned true before
/// the end. Apart from `speed`, the result depends only on the scenario (including its seed) and
/// the options, not on the number of threads; a deadline of the planner is therefore ignored.
/// Throws InputError on an unknown plant or an invalid plant file, before anything is simulated.
[[nodiscard]] std::optional<Comparison> compare_plants(const Scenario& scenario,
                                                       const ComparisonOptions& options);

}  // namespace qsmpc::harness
