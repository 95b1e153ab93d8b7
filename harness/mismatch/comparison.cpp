#include "harness/mismatch/comparison.hpp"

#include <algorithm>
#include <limits>
#include <memory>
#include <utility>

#include "controller/certification/error_budget.hpp"
#include "harness/assembly/assembly.hpp"
#include "harness/assembly/chosen_points.hpp"
#include "harness/assembly/first_decision.hpp"
#include "harness/errors.hpp"
#include "harness/mismatch/measured_error.hpp"
#include "harness/plant/plant_check.hpp"
#include "harness/plant/plant_registry.hpp"
#include "harness/scenario/known_names.hpp"
#include "harness/scenario/plant_choice.hpp"
#include "harness/scenario/scenario_file.hpp"
#include "harness/threads/executor.hpp"
#include "harness/threads/workers.hpp"
#include "harness/version.hpp"

namespace qsmpc::harness {
namespace {

constexpr int kTimedPaths = 15;  // so that a few interruptions do not affect the median

std::vector<std::string> without_repeats(const std::vector<std::string>& names) {
  std::vector<std::string> kept;
  for (const std::string& name : names) {
    if (std::ranges::find(kept, name) == kept.end()) kept.push_back(name);
  }
  return kept;
}

/// The residuals of all periods.
ResidualSample residuals_of(const std::vector<EpisodeResult>& episodes) {
  ResidualSample sample;
  for (const EpisodeResult& episode : episodes) sample.units.push_back(episode.residuals);
  return sample;
}

/// The residuals of the periods that at least half of the episodes have, truncated to whole
/// stretches of a horizon after the first `first` periods: each stretch is a separate sample.
ResidualSample stretches(const std::vector<EpisodeResult>& episodes, Eigen::Index first,
                         Eigen::Index horizon) {
  std::vector<Eigen::Index> lengths;
  lengths.reserve(episodes.size());
  for (const EpisodeResult& episode : episodes) lengths.push_back(episode.residuals.cols());
  std::sort(lengths.begin(), lengths.end());
  const Eigen::Index later = std::max<Eigen::Index>(lengths[lengths.size() / 2] - first, 0);
  const Eigen::Index common = first + later / horizon * horizon;
  ResidualSample sample{.by_period = true, .stretch = horizon};
  for (const EpisodeResult& episode : episodes) {
    sample.units.emplace_back(
        episode.residuals.leftCols(std::min(common, episode.residuals.cols())));
  }
  return sample;
}

/// A plant to be compared.
struct Candidate {
  std::string name;
  Scenario scenario;
  std::unique_ptr<PlantPool> pool{};
};

/// A comparison in progress: the data that all plants share.
class Comparing {
 public:
  Comparing(const Scenario& scenario, const ComparisonOptions& options)
      : options_(options), run_(executor_of(usable_threads(options.threads))), scenario_(scenario) {
    // One thread per episode, and no dependence on wall-clock time.
    scenario_.controller.threads = 1;
    scenario_.controller.deadline = std::numeric_limits<double>::infinity();
    model_ = model_of(scenario_);
    belief_ = {.mean = scenario.initial_state.mean,
               .covariance = scenario.initial_state.covariance};
    result_.scenario = scenario;
    result_.system = model_->description();
    result_.scenario_text = to_yaml(scenario);
    result_.version = kVersion;
    result_.paths = options.paths;
    result_.error_plant = options.error_plant;
    choose_plants();
  }

  std::optional<Comparison> run() {
    const std::int64_t units = options_.episodes + path_batches(options_.paths);
    SharedWork work(units * std::ssize(candidates_), options_.should_stop, options_.on_progress);
    if (options_.on_plants_ready) options_.on_plants_ready();
    if (work.stopped()) return std::nullopt;
    make_plan();
    for (Candidate& candidate : candidates_) {
      compare(candidate, work);
      if (work.stopped()) return std::nullopt;
    }
    measure_error();
    return std::move(result_);
  }

 private:
  [[nodiscard]] PathNumbers path_numbers() const { return {.seed = scenario_.seed, .first = 0}; }

  void choose_plants() {
    const std::vector<std::string> names =
        without_repeats(options_.plants.empty() ? default_plants(scenario_) : options_.plants);
    if (!options_.error_plant.empty() &&
        std::ranges::find(names, options_.error_plant) == names.end()) {
      throw InputError({.key = "--model-error-plant",
                        .found = options_.error_plant,
                        .expected = expected_names(options_.error_plant, names)});
    }
    // Checks all names before opening any file, so that a wrong name is reported first.
    for (const std::string& name : names) {
      candidates_.push_back({.name = name, .scenario = with_plant(scenario_, name)});
    }
    for (Candidate& candidate : candidates_) {
      const Scenario& scenario = candidate.scenario;
      try_plant(scenario);
      const auto make = [&scenario, seed = scenario_.seed](std::int64_t path) {
        return make_plant(
            scenario, draw_variation(scenario.disturbance, seed, static_cast<std::uint64_t>(path)));
      };
      candidate.pool = std::make_unique<PlantPool>(make, varies(scenario.disturbance));
    }
  }

  /// Decides once at the initial belief, certifies the plan, and simulates the model under it.
  void make_plan() {
    const FirstDecision first(scenario_, *model_);
    const controller::PredictedMotion& motion = first.motion();
    result_.policy = motion.policy;
    result_.particles = motion.prediction.stages;
    result_.certificates = certificates_of(motion);
    if (scenario_.model_error) {
      result_.with_error = certificates_of(of_plant(motion, scenario_, 0));
    }
    result_.w2_paths = w2_paths(result_.particles, options_.paths);
    source_.emplace(result_.policy, belief_, scenario_.disturbance.covariance, path_numbers());
    result_.model_paths = model_paths(*model_, *source_, options_.paths, run_);
    result_.floors = w2_floors(
        result_.particles, *model_, result_.policy, belief_, scenario_.disturbance.covariance,
        {.numbers = path_numbers(), .paths = options_.paths, .count = result_.w2_paths}, run_);
  }

  [[nodiscard]] std::vector<controller::StageCertificate> certificates_of(
      const controller::PredictedMotion& motion) const {
    return controller::certify(motion, scenario_.safe_set, controller::error_budget(motion),
                               controller::CertificateEffort::kTightest, run_);
  }

  void compare(Candidate& candidate, SharedWork& work) {
    PlantComparison plant{.name = candidate.name};
    std::unique_ptr<Plant> timed = candidate.pool->take(0);
    const bool drawn = timed != nullptr;
    if (!drawn) timed = make_plant(candidate.scenario);
    plant.speed = simulation_speed(*timed, *source_, scenario_.time_step, kTimedPaths);
    if (drawn) candidate.pool->give_back(std::move(timed));

    work.begin(candidate.name + ", episodes");
    plant.episodes = run_episodes(candidate.scenario, options_.episodes, run_, work);
    work.begin(candidate.name + ", paths of the plan");
    plant.paths = plant_paths(*candidate.pool, *model_, *source_, options_.paths, run_, work);
    if (work.stopped()) return;

    plant.closed_loop = closed_loop_of(plant.episodes);
    plant.one_step = one_step_statistics(plant.episodes);
    plant.horizon = compare_along_horizon(plant.paths, result_.model_paths, result_.particles,
                                          scenario_.safe_set, {.w2_paths = result_.w2_paths}, run_);
    plant.exceeded_stages = exceeded_stages(plant.horizon, result_.in_force());
    result_.plants.push_back(std::move(plant));
  }

  [[nodiscard]] ResidualStatistics one_step_statistics(
      const std::vector<EpisodeResult>& episodes) const {
    std::vector<Eigen::MatrixXd> residuals;
    Eigen::VectorXd magnitude = Eigen::VectorXd::Zero(model_->state_dim());
    for (const EpisodeResult& episode : episodes) {
      residuals.push_back(episode.residuals);
      magnitude = magnitude.cwiseMax(episode.magnitude);
    }
    return residual_statistics(residuals, magnitude);
  }

  void measure_error() {
    for (const PlantComparison& plant : result_.plants) {
      if (plant.name != options_.error_plant) continue;
      ResidualSample planned{.by_period = true};
      for (Eigen::Index i = 0; i < options_.paths; ++i) {
        Eigen::MatrixXd path(model_->state_dim(), std::ssize(plant.paths.residuals));
        for (Eigen::Index k = 0; k < path.cols(); ++k) {
          path.col(k) = plant.paths.residuals[static_cast<std::size_t>(k)].col(i);
        }
        planned.units.push_back(std::move(path));
      }
      // The plan's last period counts as one of the later periods.
      const Eigen::Index horizon = result_.policy.horizon();
      const Eigen::Index first = horizon - 1;
      result_.measured_error =
          measured_model_error({residuals_of(plant.episodes),
                                stretches(plant.episodes, first, horizon), std::move(planned)},
                               scenario_.seed, first);
    }
  }

  const ComparisonOptions& options_;
  controller::Executor run_;
  Scenario scenario_;  // with the settings of the simulation
  std::unique_ptr<const models::Dynamics> model_;
  controller::Gaussian belief_;
  std::vector<Candidate> candidates_;
  std::optional<PathSource> source_;
  Comparison result_;
};

}  // namespace

std::vector<std::string> default_plants(const Scenario& scenario) {
  std::vector<std::string> names{"analytic"};
  if (scenario.plant.kind == "mujoco") names.emplace_back("mujoco");
  return names;
}

std::vector<int> exceeded_stages(const std::vector<HorizonStage>& horizon,
                                 const std::vector<controller::StageCertificate>& certificates) {
  std::vector<int> stages;
  for (std::size_t k = 0; k < horizon.size(); ++k) {
    // The negation also counts a certificate that is not a number as exceeded.
    if (!(certificates[k].value >= horizon[k].unsafe_limits.lower)) {
      stages.push_back(horizon[k].stage);
    }
  }
  return stages;
}

std::optional<Comparison> compare_plants(const Scenario& scenario,
                                         const ComparisonOptions& options) {
  return Comparing(with_chosen_points(scenario), options).run();
}

}  // namespace qsmpc::harness
