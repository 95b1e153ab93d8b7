// Where a plant is at the stages of a plan, beside where the planner's model and its particles say.
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "controller/measure/measures.hpp"
#include "controller/parallel.hpp"
#include "controller/regions/unsafe_set.hpp"
#include "harness/mismatch/path_ensemble.hpp"
#include "harness/statistics/binomial_interval.hpp"

namespace qsmpc::harness {

/// Probability with which either limit of an observed rate is wrong: together they are an interval
/// of 99 %.
inline constexpr double kIntervalTail = 0.005;

/// W2 between the particles of a stage and ensembles of the model's own paths: what W2 is where the
/// plant is the model, for as many paths. It is not zero: particles are few, and so are paths.
struct W2Floor {
  double mean = 0.0;
  double deviation = 0.0;  ///< standard deviation over the ensembles
};

/// Ensembles of the model that a floor is the mean of.
inline constexpr int kFloorEnsembles = 8;

/// Most pairs of particles and paths that a distance is computed for: about 20 ms.
inline constexpr std::int64_t kPairsForW2 = 200'000;

/// Of `paths`, how many enter a distance to the largest of `stages`: fewer where there are many
/// particles.
[[nodiscard]] std::int64_t w2_paths(const std::vector<controller::DiscreteMeasure>& stages,
                                    std::int64_t paths);

/// The floors of stages 0 … horizon, from kFloorEnsembles ensembles of `count` paths each, with the
/// numbers that follow those of the first `paths` paths of `numbers`. Nothing depends on `run`.
struct FloorSettings {
  PathNumbers numbers;
  std::int64_t paths = 0;
  std::int64_t count = 0;
};
[[nodiscard]] std::vector<W2Floor> w2_floors(const std::vector<controller::DiscreteMeasure>& stages,
                                             const models::Dynamics& model,
                                             const controller::Policy& policy,
                                             const controller::Gaussian& belief,
                                             const Eigen::MatrixXd& noise_covariance,
                                             const FloorSettings& settings,
                                             const controller::Executor& run);

/// One stage of the horizon. n: state_dim.
struct HorizonStage {
  int stage = 0;
  Eigen::VectorXd divergence_rmse;  ///< √ mean (plant − model)², by state, path by path
  double w2 = 0.0;                  ///< between the particles and the plant's paths
  Eigen::VectorXd residual_rmse;    ///< of the period that leads to this stage
  std::int64_t unsafe = 0;          ///< paths whose plant is unsafe, or broken, at this stage
  RateInterval unsafe_limits;       ///< Clopper–Pearson, 99 %

  /// √ Σ divergence_rmse²: at least W2 between the laws of plant and model, as far as the paths
  /// tell, since paths with the same random numbers are a coupling of the two. 0 for the model
  /// itself, where W2 between ensembles is not.
  [[nodiscard]] double w2_to_model() const { return divergence_rmse.norm(); }
};

struct HorizonSettings {
  std::int64_t w2_paths = 0;  ///< of the plant's paths, the first so many enter W2
};

/// Stages 1 … horizon. Paths whose plant broke are unsafe from then on, and have no part in
/// divergence, residuals and W2; where none is left these are not a number. Nothing depends on
/// `run`. stages: the particles of stages 0 … horizon; model: the states of `model_paths` of the
/// same source.
[[nodiscard]] std::vector<HorizonStage> compare_along_horizon(
    const PlantPaths& plant, const std::vector<controller::Points>& model,
    const std::vector<controller::DiscreteMeasure>& stages, const controller::UnsafeSet& unsafe,
    const HorizonSettings& settings, const controller::Executor& run);

}  // namespace qsmpc::harness
