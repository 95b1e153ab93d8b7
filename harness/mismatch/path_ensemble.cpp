#include "harness/mismatch/path_ensemble.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <memory>

#include "harness/statistics/sample_statistics.hpp"
#include "models/constants.hpp"

namespace qsmpc::harness {
namespace {

std::vector<controller::Points> unknown_points(Eigen::Index stages, Eigen::Index dim,
                                               Eigen::Index count) {
  return std::vector<controller::Points>(static_cast<std::size_t>(stages),
                                         controller::Points::Constant(dim, count, kNotANumber));
}

Eigen::VectorXd model_step(const models::Dynamics& model, const Eigen::VectorXd& state,
                           const Eigen::VectorXd& input) {
  models::StateBatch next(state.size(), 1);
  model.step(models::StateBatch(state), models::StateBatch(input), next);
  return next.col(0);
}

/// Drives `plant`, or nullptr for one that the simulator rejects, along one path and fills its
/// column of `paths`. Returns whether the plant completed it.
bool drive(Plant* plant, const models::Dynamics& model, const PathSource& source, std::int64_t path,
           PlantPaths& paths) {
  Eigen::VectorXd state = source.initial_state(path);
  paths.states.front().col(path) = state;
  if (plant == nullptr) return false;
  plant->reset(state);
  for (Eigen::Index k = 0; k < source.stages(); ++k) {
    const auto stage = static_cast<std::size_t>(k);
    const Eigen::VectorXd input = controller::policy_input(source.policy(), k, state);
    const Eigen::VectorXd disturbance = source.disturbance(path, k);
    const PlantStep step = plant->advance(input, disturbance);
    if (step.fault) return false;
    paths.residuals[stage].col(path) = step.state - disturbance - model_step(model, state, input);
    paths.states[stage + 1].col(path) = step.state;
    state = step.state;
  }
  return true;
}

}  // namespace

PathSource::PathSource(const controller::Policy& policy, const controller::Gaussian& belief,
                       const Eigen::MatrixXd& noise_covariance, const PathNumbers& numbers)
    : policy_(policy),
      numbers_(numbers),
      initial_(belief.mean, belief.covariance),
      noise_(Eigen::VectorXd::Zero(belief.mean.size()), noise_covariance) {}

models::RandomKey PathSource::key(std::int64_t path, Eigen::Index step) const {
  return {.seed = numbers_.seed,
          .episode = numbers_.first + static_cast<std::uint64_t>(path),
          .stream = models::RandomStream::kPrediction,
          .step = static_cast<std::uint64_t>(step)};
}

Eigen::VectorXd PathSource::initial_state(std::int64_t path) const {
  return initial_.sample(key(path, 0));
}

Eigen::VectorXd PathSource::disturbance(std::int64_t path, Eigen::Index stage) const {
  return noise_.sample(key(path, stage + 1));
}

std::vector<controller::Points> model_paths(const models::Dynamics& model, const PathSource& source,
                                            std::int64_t count, const controller::Executor& run) {
  std::vector<controller::Points> stages =
      unknown_points(source.stages() + 1, model.state_dim(), count);
  run(static_cast<int>(path_batches(count)), [&](int batch) {
    const std::int64_t begin = batch * kPathBatch;
    const std::int64_t size = std::min(kPathBatch, count - begin);
    controller::Points states(model.state_dim(), size);
    controller::Points next(model.state_dim(), size);
    controller::Points inputs(model.input_dim(), size);
    for (Eigen::Index i = 0; i < size; ++i) states.col(i) = source.initial_state(begin + i);
    stages.front().middleCols(begin, size) = states;
    for (Eigen::Index k = 0; k < source.stages(); ++k) {
      controller::policy_inputs(source.policy(), k, states, inputs);
      model.step(states, inputs, next);
      for (Eigen::Index i = 0; i < size; ++i) next.col(i) += source.disturbance(begin + i, k);
      states.swap(next);
      stages[static_cast<std::size_t>(k) + 1].middleCols(begin, size) = states;
    }
  });
  return stages;
}

PlantPaths plant_paths(PlantPool& plants, const models::Dynamics& model, const PathSource& source,
                       std::int64_t count, const controller::Executor& run, SharedWork& work) {
  PlantPaths paths{.states = unknown_points(source.stages() + 1, model.state_dim(), count),
                   .residuals = unknown_points(source.stages(), model.state_dim(), count)};
  std::atomic<std::int64_t> faults = 0;
  run(static_cast<int>(path_batches(count)), [&](int batch) {
    if (work.stopped()) return;
    const std::int64_t begin = batch * kPathBatch;
    const std::int64_t end = std::min(begin + kPathBatch, count);
    for (std::int64_t path = begin; path < end; ++path) {
      std::unique_ptr<Plant> plant = plants.take(path);
      if (!drive(plant.get(), model, source, path, paths)) ++faults;
      plants.give_back(std::move(plant));
    }
    work.advance();
  });
  paths.faults = faults;
  return paths;
}

double simulation_speed(Plant& plant, const PathSource& source, double time_step, int count) {
  using Clock = std::chrono::steady_clock;
  std::vector<double> speeds;
  for (int path = 0; path < count; ++path) {
    Eigen::VectorXd state = source.initial_state(path);
    plant.reset(state);
    Eigen::Index done = 0;
    const auto start = Clock::now();
    for (; done < source.stages(); ++done) {
      PlantStep step = plant.advance(controller::policy_input(source.policy(), done, state),
                                     source.disturbance(path, done));
      if (step.fault) break;
      state = std::move(step.state);
    }
    const double wall = std::chrono::duration<double>(Clock::now() - start).count();
    speeds.push_back(static_cast<double>(done) * time_step / wall);
  }
  return median_of(std::move(speeds));
}

}  // namespace qsmpc::harness
