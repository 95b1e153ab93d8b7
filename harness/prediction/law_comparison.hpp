// How near methods of prediction come to the laws that simulated paths show.
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

/// Paths that a law is compared with in W2, and draws of a law that is not made of points: the
/// transport problem of so many pairs is solved exactly.
inline constexpr std::int64_t kTransportPaths = 1000;
/// Paths that are kept of a simulation for this: two samples, for what sampling alone gives.
inline constexpr std::int64_t kKeptPaths = 2 * kTransportPaths;
/// Quasi-random draws from which the unsafe probability of a law that is not made of points comes.
inline constexpr std::int64_t kProbabilityDraws = std::int64_t{1} << 17;
/// Runs of which the median time is reported: so many, or those that begin within this time, s.
inline constexpr int kTimedRuns = 5;
inline constexpr double kTimedSeconds = 2.0;

/// Of a law at one stage; not a number where the law is not finite, but for the probability, 1.
struct LawErrors {
  double w2 = 0.0;          ///< to kTransportPaths paths, units of the states added as they are
  double mean = 0.0;        ///< |m − m_true|
  double covariance = 0.0;  ///< |Σ − Σ_true|_F/|Σ_true|_F
  double unsafe = 0.0;      ///< the probability of being unsafe that the law says
};

/// What these errors are for a law that is right, by the sampling of the truth alone.
struct LawFloor {
  double w2 = 0.0;          ///< between two disjoint samples of kTransportPaths paths
  double mean = 0.0;        ///< root mean square
  double covariance = 0.0;  ///< root mean square, of a Gaussian
};

struct MethodErrors {
  std::string name;
  double milliseconds = 0.0;  ///< of the whole horizon in one thread; median of up to kTimedRuns
  std::vector<LawErrors> stages;  ///< 1 … horizon
};

struct LawComparison {
  PathLaws truth;                ///< of which `paths` are not kept
  std::vector<LawFloor> floors;  ///< stages 1 … horizon
  std::vector<MethodErrors> methods;
};

struct LawComparisonOptions {
  std::vector<std::string> methods;  ///< names of controller::law_methods()
  controller::LawSettings settings{};
  int threads = 0;  ///< 0: as many as the processor runs at once; timing takes one
  /// Asked between pieces of work, by several threads; true gives the work up.
  std::function<bool()> should_stop{};
};

/// `paths`: of the model of `motion` under its policy, with kKeptPaths paths kept. Numbers do not
/// depend on the number of threads; times do. Nothing if `should_stop` said so. Throws
/// std::invalid_argument on unknown names and without paths enough.
[[nodiscard]] std::optional<LawComparison> compare_laws(const controller::PredictedMotion& motion,
                                                        const controller::SafeSet& safe_set,
                                                        PathLaws paths,
                                                        const LawComparisonOptions& options);

}  // namespace qsmpc::harness
