#include "controller/certification/conditioned_bounds.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "controller/certification/affine_surrogate.hpp"
#include "controller/certification/first_entry.hpp"
#include "controller/certification/surrogate_bounds.hpp"
#include "models/constants.hpp"

namespace qsmpc::controller {
namespace {

// How near a grid point the first, second and third functionals are held, in their deviations …
constexpr std::array kSpreads = {0.25, 0.35, 0.5};
// … and the factor by which this is narrowed, once or twice, where that reduces the errors by this
// share.
constexpr double kNarrowing = 0.4;
constexpr double kNarrowingGain = 0.25;
// The largest number of grid points beyond the first grid, and of parts of the unsafe set over all
// grid points and stages.
constexpr double kMostPlaces = 500.0;
constexpr double kMostParts = 1e5;
// A functional must reduce the errors by this share.
constexpr double kLeastGain = 0.1;
// A bound within this factor, plus this margin, of its value without any error is not conditioned.
constexpr double kTightEnough = 1.25;
constexpr double kSmallEnough = 1e-6;
// Neither is one whose value without any error exceeds this.
constexpr double kHopeless = 0.5;

using PathWeights = std::vector<Eigen::VectorXd>;

/// The weights of lᵀ z_stage: Λ_j = Φ_{stage,j}ᵀ l.
PathWeights weights_of(const std::vector<SurrogateStage>& stages, std::size_t stage,
                       Eigen::VectorXd direction) {
  PathWeights weights(stages.size(), Eigen::VectorXd::Zero(direction.size()));
  for (std::size_t j = stage + 1; j-- > 0;) {
    weights[j] = direction;
    if (j > 0) direction = (stages[j - 1].transition.transpose() * direction).eval();
  }
  return weights;
}

/// The same, restricted to one coordinate's own noise.
PathWeights own_noise(PathWeights weights, Eigen::Index axis) {
  for (Eigen::VectorXd& block : weights) {
    const double own = block[axis];
    block.setZero();
    block[axis] = own;
  }
  return weights;
}

/// Candidate functionals: the coordinates in which the motion is nonlinear and the inputs'
/// feedback, at the first, middle and last known stages.
std::vector<PathWeights> candidates(const PredictedMotion& motion,
                                    const std::vector<SurrogateStage>& stages) {
  const Eigen::Index dim = motion.belief.mean.size();
  const std::vector<bool> affine = affine_coordinates(motion.dynamics);
  std::size_t known = 0;
  while (known < stages.size() && stages[known].transition.size() > 0) ++known;
  std::vector<PathWeights> found;
  if (known == 0) return found;
  const auto unicycle = motion.dynamics.unicycle();
  std::vector<std::size_t> at = {0, known / 2, known - 1};
  at.erase(std::unique(at.begin(), at.end()), at.end());
  for (const std::size_t k : at) {
    for (Eigen::Index a = 0; a < dim; ++a) {
      const bool heading = unicycle && a == unicycle->heading;
      if (affine[static_cast<std::size_t>(a)] && !heading) continue;
      const PathWeights weights = weights_of(stages, k, Eigen::VectorXd::Unit(dim, a));
      found.push_back(weights);
      if (heading && k > 0) found.push_back(own_noise(weights, a));
    }
    const Eigen::MatrixXd& gain = motion.policy.gains[k];
    for (Eigen::Index b = 0; b < gain.rows(); ++b) {
      if (!gain.row(b).isZero(0.0)) found.push_back(weights_of(stages, k, gain.row(b).transpose()));
    }
  }
  return found;
}

/// Sum of the errors of all stages and coordinates relative to the deviations in `whole`, each at
/// most 1.
double relative_errors(const std::vector<SurrogateStage>& stages,
                       const std::vector<SurrogateStage>& whole) {
  double sum = 0.0;
  for (std::size_t k = 1; k < stages.size(); ++k) {
    for (Eigen::Index i = 0; i < stages[k].error.size(); ++i) {
      const double variance = whole[k].law.covariance(i, i);
      const double error = stages[k].error[i];
      if (error == 0.0) continue;
      const double relative = variance > 0.0 ? error / std::sqrt(variance) : 1.0;
      sum += relative < 1.0 ? relative : 1.0;
    }
  }
  return sum;
}

/// The functionals held, and how near a grid point.
struct Held {
  PathFunctionals functionals{};
  Eigen::VectorXd spreads{};
};

/// The same with the functionals held, averaged over a few places.
double held_errors(const PredictedMotion& motion, const Held& held,
                   const std::vector<SurrogateStage>& whole) {
  PathTilt tilt{.functionals = held.functionals, .centre = {}, .spreads = held.spreads};
  double sum = 0.0;
  for (const double place : {-1.0, 0.0, 1.0}) {
    tilt.centre = Eigen::VectorXd::Constant(held.spreads.size(), place);
    sum += relative_errors(affine_surrogates(motion, kWideCore, tilt), whole) / 3.0;
  }
  return sum;
}

/// Number of points of a grid.
double places_of(const Eigen::VectorXd& spreads) {
  return static_cast<double>(tilt_grid(spreads).weights.size());
}

/// Narrows the spread of the last functional where this reduces the errors much, with at most
/// `most` grid points.
void narrow(const PredictedMotion& motion, const std::vector<SurrogateStage>& whole, double errors,
            double most, Held& held) {
  for (int times = 0; times < 2; ++times) {
    Held nearer = held;
    nearer.spreads[nearer.spreads.size() - 1] *= kNarrowing;
    if (places_of(nearer.spreads) > most) return;
    const double left = held_errors(motion, nearer, whole);
    if (!(left < (1.0 - kNarrowingGain) * errors)) return;
    errors = left;
    held = std::move(nearer);
  }
}

/// Adds the functional that, held together with the existing ones, minimises the surrogate's errors
/// relative to its deviations. Returns false where none gains much, or where more than `most` grid
/// points would be needed.
bool hold_one_more(const PredictedMotion& motion, const std::vector<SurrogateStage>& whole,
                   double most, Held& held) {
  const Eigen::Index count = held.spreads.size();
  const double before =
      count == 0 ? relative_errors(whole, whole) : held_errors(motion, held, whole);
  Held tried{.functionals = {}, .spreads = held.spreads};
  tried.spreads.conservativeResize(count + 1);
  tried.spreads[count] = kSpreads[static_cast<std::size_t>(count)];
  if (count > 0 && places_of(tried.spreads) > most) return false;
  double errors = (1.0 - kLeastGain) * before;
  Held best;
  for (const PathWeights& weights : candidates(motion, whole)) {
    tried.functionals = held.functionals;
    if (!add_functional(motion, weights, tried.functionals)) continue;
    const double left = held_errors(motion, tried, whole);
    if (!(left < errors)) continue;
    errors = left;
    best = tried;
  }
  if (best.spreads.size() == 0) return false;
  narrow(motion, whole, errors, most, best);
  held = std::move(best);
  return true;
}

/// Bounds of all stages from the tilted laws of a grid, and their values without errors.
struct TiltedSums {
  Eigen::VectorXd bounds;
  Eigen::VectorXd without_errors;
};

/// known: 0 at stages that are not requested.
TiltedSums tilted_sums(const PredictedMotion& motion, const UnsafeSet& unsafe, const Held& held,
                       const std::vector<RegionProbability>& known, const Executor& run) {
  const TiltGrid grid = tilt_grid(held.spreads);
  const auto horizon = static_cast<Eigen::Index>(known.size());
  Eigen::MatrixXd tilted(horizon, grid.centres.cols());
  Eigen::MatrixXd without_errors(horizon, grid.centres.cols());
  const auto place = [&](int i) {
    const PathTilt tilt{
        .functionals = held.functionals, .centre = grid.centres.col(i), .spreads = held.spreads};
    const SurrogateBounds found =
        surrogate_bounds(motion, unsafe, CertificateEffort::kEvery, run_in_turn, tilt, known);
    for (Eigen::Index k = 0; k < horizon; ++k) {
      const auto index = static_cast<std::size_t>(k);
      tilted(k, i) = found.bounds[index].smooth;
      without_errors(k, i) = known[index].smooth == 0.0
                                 ? 0.0
                                 : surrogate_law_bound(unsafe, k + 1, found.surrogates[index + 1]);
    }
  };
  run(static_cast<int>(grid.centres.cols()), place);
  const auto sum = [&](const Eigen::MatrixXd& values) -> Eigen::VectorXd {
    return (grid.factor * ((values * grid.weights).array() + grid.left_out)).cwiseMin(1.0);
  };
  return {.bounds = sum(tilted), .without_errors = sum(without_errors)};
}

/// First entries of all stages under the tilted laws of a grid, summed.
std::vector<double> tilted_entries(const PredictedMotion& motion, const UnsafeSet& unsafe,
                                   const Held& held, const Executor& run) {
  const TiltGrid grid = tilt_grid(held.spreads);
  Eigen::MatrixXd entries(motion.policy.horizon(), grid.centres.cols());
  const auto place = [&](int i) {
    const PathTilt tilt{
        .functionals = held.functionals, .centre = grid.centres.col(i), .spreads = held.spreads};
    const std::vector<double> found = first_entry_bounds(
        unsafe, surrogate_bounds(motion, unsafe, CertificateEffort::kEvery, run_in_turn, tilt));
    // Under each law the entries of all stages so far sum to at most 1.
    double before = 0.0;
    for (Eigen::Index k = 0; k < entries.rows(); ++k) {
      const double sum = std::min(1.0, before + found[static_cast<std::size_t>(k)]);
      entries(k, i) = sum - before;
      before = sum;
    }
  };
  run(static_cast<int>(grid.centres.cols()), place);
  Eigen::VectorXd sum = grid.factor * (entries * grid.weights);
  sum[0] += grid.factor * grid.left_out;
  return {sum.begin(), sum.end()};
}

}  // namespace

ConditionedBounds conditioned_bounds(const PredictedMotion& motion, const UnsafeSet& unsafe,
                                     const SurrogateBounds& plain, const Executor& run) {
  const auto horizon = static_cast<Eigen::Index>(plain.bounds.size());
  ConditionedBounds result{.stages = std::vector<double>(plain.bounds.size(), 1.0), .entries = {}};
  std::vector<double>& bounds = result.stages;
  if (motion.model_error != nullptr || motion.belief_error != nullptr) return result;
  // Each stage's bound, and its value without any error.
  Eigen::VectorXd least(horizon);
  Eigen::VectorXd lowest(horizon);
  for (Eigen::Index k = 0; k < horizon; ++k) {
    const auto index = static_cast<std::size_t>(k);
    least[k] = plain.bounds[index].smooth;
    lowest[k] = surrogate_law_bound(unsafe, k + 1, plain.surrogates[index + 1]);
  }
  double parts = 0.0;
  for (const DiscView& disc : unsafe.discs()) parts += static_cast<double>(disc.regions.size());
  Held held;
  for (std::size_t count = 1; count <= kSpreads.size(); ++count) {
    std::vector<RegionProbability> known(plain.bounds.size());
    double asked = 0.0;
    for (Eigen::Index k = 0; k < horizon; ++k) {
      if (least[k] <= kTightEnough * lowest[k] + kSmallEnough || lowest[k] > kHopeless) continue;
      known[static_cast<std::size_t>(k)] = {.markov = 1.0, .smooth = 1.0};
      asked += parts;
    }
    if (asked == 0.0) break;
    const double most = std::min(kMostPlaces, kMostParts / asked);
    if (!hold_one_more(motion, plain.surrogates, most, held)) break;
    const TiltedSums sums = tilted_sums(motion, unsafe, held, known, run);
    for (Eigen::Index k = 0; k < horizon; ++k) {
      if (known[static_cast<std::size_t>(k)].smooth == 0.0) continue;
      double& bound = bounds[static_cast<std::size_t>(k)];
      bound = std::min(bound, sums.bounds[k]);
      least[k] = std::min(least[k], bound);
      lowest[k] = sums.without_errors[k];
    }
  }
  if (held.spreads.size() > 0 && lowest.maxCoeff() <= kHopeless) {
    result.entries = tilted_entries(motion, unsafe, held, run);
  }
  return result;
}

}  // namespace qsmpc::controller
