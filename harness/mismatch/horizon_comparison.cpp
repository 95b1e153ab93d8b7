#include "harness/mismatch/horizon_comparison.hpp"

#include <algorithm>

#include "controller/measure/wasserstein.hpp"
#include "harness/statistics/sample_statistics.hpp"
#include "models/constants.hpp"

namespace qsmpc::harness {
namespace {

/// The first `most` finite columns of `points`, equally weighted.
controller::DiscreteMeasure empirical_measure(const controller::Points& points, std::int64_t most) {
  std::vector<Eigen::Index> kept;
  for (Eigen::Index i = 0; i < points.cols() && std::ssize(kept) < most; ++i) {
    if (points.col(i).allFinite()) kept.push_back(i);
  }
  const auto count = std::ssize(kept);
  return {.locations = points(Eigen::all, kept),
          .weights = Eigen::VectorXd::Constant(count, 1.0 / static_cast<double>(count))};
}

double w2_to(const controller::DiscreteMeasure& particles, const controller::Points& points,
             std::int64_t most) {
  const controller::DiscreteMeasure measure = empirical_measure(points, most);
  return measure.size() == 0 ? kNotANumber : controller::wasserstein2(particles, measure);
}

/// √ mean |column|² by row, over the finite columns.
Eigen::VectorXd rms_of_finite(const controller::Points& values) {
  Eigen::VectorXd squares = Eigen::VectorXd::Zero(values.rows());
  double count = 0.0;
  for (const auto& column : values.colwise()) {
    if (!column.allFinite()) continue;
    squares += column.cwiseAbs2();
    count += 1.0;
  }
  return (squares / count).cwiseSqrt();  // without any column, 0/0: not a number
}

std::int64_t count_unsafe(const controller::Points& states, const controller::UnsafeSet& unsafe) {
  return std::ranges::count_if(states.colwise(), [&](const auto& column) {
    const Eigen::VectorXd state = column;
    return !state.allFinite() || controller::distance_to_unsafe(state, unsafe) <= 0.0;
  });
}

W2Floor floor_of(const std::vector<double>& distances) {
  const double mean = mean_of_shares(distances);
  return {.mean = mean, .deviation = standard_deviation_about(distances, mean)};
}

}  // namespace

std::int64_t w2_paths(const std::vector<controller::DiscreteMeasure>& stages, std::int64_t paths) {
  Eigen::Index largest = 1;
  for (const controller::DiscreteMeasure& stage : stages) largest = std::max(largest, stage.size());
  return std::clamp<std::int64_t>(kPairsForW2 / largest, 1, paths);
}

std::vector<W2Floor> w2_floors(const std::vector<controller::DiscreteMeasure>& stages,
                               const models::Dynamics& model, const controller::Policy& policy,
                               const controller::Gaussian& belief,
                               const Eigen::MatrixXd& noise_covariance,
                               const FloorSettings& settings, const controller::Executor& run) {
  std::vector<std::vector<double>> distances(stages.size(), std::vector<double>(kFloorEnsembles));
  for (int n = 0; n < kFloorEnsembles; ++n) {
    PathNumbers numbers = settings.numbers;
    numbers.first += static_cast<std::uint64_t>(settings.paths + n * settings.count);
    const PathSource source(policy, belief, noise_covariance, numbers);
    const std::vector<controller::Points> paths = model_paths(model, source, settings.count, run);
    run(static_cast<int>(stages.size()), [&](int k) {
      const auto stage = static_cast<std::size_t>(k);
      distances[stage][static_cast<std::size_t>(n)] =
          w2_to(stages[stage], paths[stage], settings.count);
    });
  }
  std::vector<W2Floor> floors;
  floors.reserve(distances.size());
  for (const std::vector<double>& of_stage : distances) floors.push_back(floor_of(of_stage));
  return floors;
}

std::vector<HorizonStage> compare_along_horizon(
    const PlantPaths& plant, const std::vector<controller::Points>& model,
    const std::vector<controller::DiscreteMeasure>& stages, const controller::UnsafeSet& unsafe,
    const HorizonSettings& settings, const controller::Executor& run) {
  std::vector<HorizonStage> compared(stages.size() - 1);
  run(static_cast<int>(compared.size()), [&](int n) {
    const std::size_t k = static_cast<std::size_t>(n) + 1;
    HorizonStage& stage = compared[k - 1];
    stage.stage = static_cast<int>(k);
    stage.divergence_rmse = rms_of_finite(plant.states[k] - model[k]);
    stage.residual_rmse = rms_of_finite(plant.residuals[k - 1]);
    stage.w2 = w2_to(stages[k], plant.states[k], settings.w2_paths);
    stage.unsafe = count_unsafe(plant.states[k], unsafe);
    stage.unsafe_limits = clopper_pearson(stage.unsafe, plant.states[k].cols(), kIntervalTail);
  });
  return compared;
}

}  // namespace qsmpc::harness
