// The prediction shown in Fig. 4-1, 4-2, 5-1 and Table 5-1: a car on a turn of constant rate,
// without control.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "controller/measure/measures.hpp"
#include "controller/parallel.hpp"
#include "harness/prediction/prediction_report.hpp"

namespace qsmpc::harness {

inline constexpr double kTurnRate = 0.3;  ///< rad/s, of Fig. 4-1

/// The shipped scenario `dubins_prediction` with `overrides` (KEY=VALUE), turning at kTurnRate for
/// `stages` periods. samples: number of simulated paths to check the certificates with.
[[nodiscard]] PredictionReport on_a_turn(int stages, const std::vector<std::string>& overrides = {},
                                         std::int64_t samples = 0);

/// `count` paths of the model under the policy of `report`, by stage: those of the scenario's seed
/// numbered from `first` on. Without noise, only the initial states differ.
struct PathChoice {
  std::uint64_t first = 0;
  std::int64_t count = 0;
  bool with_noise = true;
};
[[nodiscard]] std::vector<controller::Points> samples_of(const PredictionReport& report,
                                                         const PathChoice& choice,
                                                         const controller::Executor& run);

/// The measure with the same weight on every column of `points`.
[[nodiscard]] controller::DiscreteMeasure equally_weighted(const controller::Points& points);

}  // namespace qsmpc::harness
