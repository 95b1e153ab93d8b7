#include "harness/prediction/law_comparison.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <limits>
#include <memory>
#include <stdexcept>
#include <utility>

#include "controller/measure/wasserstein.hpp"
#include "harness/elapsed.hpp"
#include "harness/statistics/sample_statistics.hpp"
#include "harness/threads/workers.hpp"

namespace qsmpc::harness {
namespace {

using Laws = std::vector<controller::StageLaw>;

// Arbitrary: the draws of a law are independent of the paths.
constexpr std::uint64_t kDrawSeed = 1;

controller::DiscreteMeasure uniform_points(const controller::Points& points) {
  return {.locations = points,
          .weights =
              Eigen::VectorXd::Constant(points.cols(), 1.0 / static_cast<double>(points.cols()))};
}

/// Compares the laws of all methods, stage by stage; the stages are distributed among threads.
class LawJudge {
 public:
  LawJudge(const controller::SafeSet& safe_set, const PathLaws& truth)
      : unsafe_(safe_set),
        truth_(truth),
        transport_draws_(controller::random_draws(safe_set.dim(), kTransportPaths, kDrawSeed)),
        probability_draws_(controller::quasi_random_draws(safe_set.dim(), kProbabilityDraws)) {}

  [[nodiscard]] LawErrors errors(const controller::StageLaw& law, std::size_t stage) const {
    constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
    const controller::Gaussian& moments = truth_.moments[stage - 1];
    LawErrors errors{.w2 = kNone,
                     .mean = kNone,
                     .covariance = kNone,
                     .unsafe = controller::unsafe_probability(law, unsafe_, probability_draws_)};
    if (!controller::is_finite(law)) return errors;
    errors.mean = (controller::mean_of(law) - moments.mean).norm();
    errors.covariance =
        (controller::covariance_of(law) - moments.covariance).norm() / moments.covariance.norm();
    const controller::DiscreteMeasure paths = first_sample(stage);
    if (paths.locations.allFinite()) {
      errors.w2 = controller::wasserstein2(as_points(law), paths);
    }
    return errors;
  }

  [[nodiscard]] LawFloor floor_of(std::size_t stage) const {
    const Eigen::MatrixXd& covariance = truth_.moments[stage - 1].covariance;
    const double trace = covariance.trace();
    const double norm = covariance.norm();
    const auto samples = static_cast<double>(truth_.samples);
    LawFloor floor{.w2 = std::numeric_limits<double>::quiet_NaN(),
                   .mean = std::sqrt(trace / samples),
                   .covariance = std::sqrt((trace * trace + norm * norm) / samples) / norm};
    const controller::Points& paths = truth_.paths[stage - 1];
    if (paths.allFinite()) {
      floor.w2 = controller::wasserstein2(first_sample(stage),
                                          uniform_points(paths.rightCols(kTransportPaths)));
    }
    return floor;
  }

 private:
  [[nodiscard]] controller::DiscreteMeasure first_sample(std::size_t stage) const {
    return uniform_points(truth_.paths[stage - 1].leftCols(kTransportPaths));
  }

  /// A law's points unchanged, unless there are too many of them; otherwise draws.
  [[nodiscard]] controller::DiscreteMeasure as_points(const controller::StageLaw& law) const {
    const auto* points = std::get_if<controller::DiscreteMeasure>(&law);
    if (points != nullptr && points->size() <= kTransportPaths) return *points;
    return uniform_points(controller::law_draws(law, transport_draws_));
  }

  controller::UnsafeSet unsafe_;
  const PathLaws& truth_;
  controller::StandardDraws transport_draws_;
  controller::StandardDraws probability_draws_;
};

/// Computes and times the laws of one method.
Laws timed_laws(const std::string& name, const controller::LawProblem& problem,
                const controller::LawSettings& settings, MethodErrors& method) {
  const auto propagator = controller::make_law_propagator(name, settings);
  std::vector<double> times;
  Laws laws;
  double spent = 0.0;
  while (times.size() < kTimedRuns && spent < 1e3 * kTimedSeconds) {
    const auto start = std::chrono::steady_clock::now();
    laws = propagator->propagate(problem);
    times.push_back(milliseconds_since(start));
    spent += times.back();
  }
  method.name = name;
  method.milliseconds = median_of(times);
  return laws;
}

}  // namespace

std::optional<LawComparison> compare_laws(const controller::PredictedMotion& motion,
                                          const controller::SafeSet& safe_set, PathLaws paths,
                                          const LawComparisonOptions& options) {
  const std::size_t horizon = paths.paths.size();
  if (horizon == 0 || paths.paths.front().cols() < kKeptPaths) {
    throw std::invalid_argument("comparison of laws: too few paths were kept");
  }
  const auto stopped = [&] { return options.should_stop && options.should_stop(); };
  const controller::LawProblem problem{.dynamics = motion.dynamics,
                                       .belief = motion.belief,
                                       .noise_covariance = motion.noise_covariance,
                                       .policy = motion.policy};
  LawComparison comparison;
  comparison.methods.resize(options.methods.size());
  std::vector<Laws> laws;
  for (std::size_t n = 0; n < options.methods.size(); ++n) {
    if (stopped()) return std::nullopt;
    laws.push_back(
        timed_laws(options.methods[n], problem, options.settings, comparison.methods[n]));
    comparison.methods[n].stages.resize(horizon);
  }
  comparison.floors.resize(horizon);
  const LawJudge judge(safe_set, paths);
  // One piece of work per stage and method, and one more per stage for its floor.
  const std::size_t columns = laws.size() + 1;
  std::atomic<std::size_t> next = 0;
  std::atomic<bool> given_up = false;
  run_workers(options.threads > 0 ? options.threads : available_threads(), [&](int) {
    for (std::size_t piece = next++; piece < columns * horizon && !given_up; piece = next++) {
      if (stopped()) given_up = true;
      const std::size_t stage = piece / columns + 1;
      const std::size_t n = piece % columns;
      if (n == laws.size()) {
        comparison.floors[stage - 1] = judge.floor_of(stage);
      } else {
        comparison.methods[n].stages[stage - 1] = judge.errors(laws[n][stage], stage);
      }
    }
  });
  if (given_up) return std::nullopt;
  comparison.truth = std::move(paths);
  comparison.truth.paths.clear();
  return comparison;
}

}  // namespace qsmpc::harness
