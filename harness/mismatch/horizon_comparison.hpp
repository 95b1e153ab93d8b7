// A plant's states at the stages of a plan, compared with the planner's model and its particles.
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

/// Probability of error of either limit of an observed rate; both together form a 99 % interval.
inline constexpr double kIntervalTail = 0.005;

/// W2 between the particles of a stage and ensembles of the model's own paths: the reference value
/// of W2 for a plant that equals the model, with as many paths. It is not zero, since the numbers
/// of particles and paths are finite.
struct W2Floor {
  double mean = 0.0;
  double deviation = 0.0;  ///< standard deviation over the ensembles
};

/// Number of ensembles of the model that a floor averages over.
inline constexpr int kFloorEnsembles = 8;

/// Most pairs of particles and paths for computing a distance: about 20 ms.
inline constexpr std::int64_t kPairsForW2 = 200'000;

/// The number of `paths` used for a distance to the largest of `stages`: fewer if there are many
/// particles.
[[nodiscard]] std::int64_t w2_paths(const std::vector<controller::DiscreteMeasure>& stages,
                                    std::int64_t paths);

/// The floors of stages 0 … horizon, from kFloorEnsembles ensembles of `count` paths each, whose
/// numbers follow those of the first `paths` paths of `numbers`. The result does not depend on
/// `run`.
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
  Eigen::VectorXd residual_rmse;    ///< of the period that ends at this stage
  std::int64_t unsafe = 0;          ///< paths whose plant is unsafe, or has failed, at this stage
  RateInterval unsafe_limits;       ///< Clopper–Pearson, 99 %

  /// √ Σ divergence_rmse²: an estimate of an upper bound on W2 between the laws of plant and model,
  /// since paths with the same random numbers are a coupling of the two. 0 for the model itself,
  /// unlike W2 between ensembles.
  [[nodiscard]] double w2_to_model() const { return divergence_rmse.norm(); }
};

struct HorizonSettings {
  std::int64_t w2_paths = 0;  ///< number of the plant's paths, from the first, that enter W2
};

/// Stages 1 … horizon. Paths whose plant has failed count as unsafe from then on, and are excluded
/// from divergence, residuals and W2, which are not a number where no path is left. The result does
/// not depend on `run`. stages: the particles of stages 0 … horizon; model: the states of
/// `model_paths` of the same source.
[[nodiscard]] std::vector<HorizonStage> compare_along_horizon(
    const PlantPaths& plant, const std::vector<controller::Points>& model,
    const std::vector<controller::DiscreteMeasure>& stages, const controller::UnsafeSet& unsafe,
    const HorizonSettings& settings, const controller::Executor& run);

}  // namespace qsmpc::harness
