// How well prediction methods match the laws of simulated paths.
//
//   LawComparison comparison = compare_laws(motion, safe_set, paths, {.methods = {"unscented"}});
//   comparison.methods[0].stages.back().w2;
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "controller/laws/law_propagator.hpp"
#include "controller/prediction/prediction.hpp"
#include "controller/regions/safe_set.hpp"
#include "harness/prediction/path_collector.hpp"

namespace qsmpc::harness {

/// Number of paths that a law is compared with in W2, and of draws from a law that is not discrete.
/// The transport problem of this size is solved exactly.
inline constexpr std::int64_t kTransportPaths = 1000;
/// Number of paths of a simulation that are kept for this: two samples, to determine the error due
/// to sampling alone.
inline constexpr std::int64_t kKeptPaths = 2 * kTransportPaths;
/// Number of quasi-random draws that give the unsafe probability of a law that is not discrete.
inline constexpr std::int64_t kProbabilityDraws = std::int64_t{1} << 17;
/// Runs whose median time is reported: this many, or as many as begin within this time, s.
inline constexpr int kTimedRuns = 5;
inline constexpr double kTimedSeconds = 2.0;

/// Errors of a law at one stage. If the law is not finite, the errors are NaN and the probability
/// is 1.
struct LawErrors {
  double w2 = 0.0;          ///< to kTransportPaths paths; units of the states are mixed unscaled
  double mean = 0.0;        ///< |m − m_true|
  double covariance = 0.0;  ///< |Σ − Σ_true|_F/|Σ_true|_F
  double unsafe = 0.0;      ///< the probability of being unsafe under the law
};

/// The errors of an exact law, due to the sampling of the truth alone.
struct LawFloor {
  double w2 = 0.0;          ///< between two disjoint samples of kTransportPaths paths
  double mean = 0.0;        ///< root mean square
  double covariance = 0.0;  ///< root mean square, for a Gaussian
};

struct MethodErrors {
  std::string name;
  double milliseconds = 0.0;  ///< for the whole horizon in one thread; median of up to kTimedRuns
  std::vector<LawErrors> stages;  ///< 1 … horizon
};

struct LawComparison {
  PathLaws truth;                ///< without its `paths`
  std::vector<LawFloor> floors;  ///< stages 1 … horizon
  std::vector<MethodErrors> methods;
};

struct LawComparisonOptions {
  std::vector<std::string> methods;  ///< names of controller::law_methods()
  controller::LawSettings settings{};
  int threads = 0;  ///< 0: as many as the processor runs concurrently; timing uses one
  /// Called between pieces of work, by several threads; true abandons the work.
  std::function<bool()> should_stop{};
};

/// `paths`: of the model of `motion` under its policy, with kKeptPaths paths kept. Results do not
/// depend on the number of threads; times do. Returns nothing if `should_stop` returned true.
/// Throws std::invalid_argument on unknown names or too few paths.
[[nodiscard]] std::optional<LawComparison> compare_laws(const controller::PredictedMotion& motion,
                                                        const controller::SafeSet& safe_set,
                                                        PathLaws paths,
                                                        const LawComparisonOptions& options);

}  // namespace qsmpc::harness
