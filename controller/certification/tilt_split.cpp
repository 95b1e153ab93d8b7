#include "controller/certification/tilt_split.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

namespace qsmpc::controller {
namespace {

// How near a grid point a functional is held, in its deviations under the law that is split …
constexpr double kSpread = 0.25;
// … and the factor by which this is narrowed, once or twice, where that reduces the errors by this
// share.
constexpr double kNarrowing = 0.4;
constexpr double kNarrowingGain = 0.5;
// A functional held nearer than this is not narrowed again: variances would cancel to rounding.
constexpr double kNarrowest = 1e-3;
// The core with which errors are compared.
constexpr double kCore = kNarrowCore;
// A split must reduce the errors by this share.
constexpr double kLeastGain = 0.02;

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

/// Sum of the errors of all stages and coordinates relative to the deviations in `untilted`, each
/// at most 1.
double relative_errors(const std::vector<SurrogateStage>& stages,
                       const std::vector<SurrogateStage>& untilted) {
  double sum = 0.0;
  for (std::size_t k = 1; k < stages.size(); ++k) {
    for (Eigen::Index i = 0; i < stages[k].error.size(); ++i) {
      const double variance = untilted[k].law.covariance(i, i);
      const double error = stages[k].error[i];
      if (error == 0.0) continue;
      const double relative = variance > 0.0 ? error / std::sqrt(variance) : 1.0;
      sum += relative < 1.0 ? relative : 1.0;
    }
  }
  return sum;
}

/// A law, and the functional along which it can be split.
struct Direction {
  PathTilt law;
  Eigen::Index axis;

  /// Its part at `place`, of the given spread, both in deviations of the functional.
  [[nodiscard]] PathTilt part(double place, double spread) const {
    PathTilt result = law;
    result.centre[axis] += law.spreads[axis] * place;
    result.spreads[axis] *= spread;
    return result;
  }
};

/// The functionals already held, and new ones uncorrelated with these: a new one has its untilted
/// law under the tilt, N(0, 1).
std::vector<Direction> directions_of(const PredictedMotion& motion, const PathTilt& tilt,
                                     const std::vector<SurrogateStage>& stages) {
  std::vector<Direction> directions;
  const Eigen::Index count = tilt.functionals.count();
  for (Eigen::Index axis = 0; axis < count; ++axis) {
    if (tilt.spreads[axis] > kNarrowest) directions.push_back({tilt, axis});
  }
  for (const PathWeights& weights : candidates(motion, stages)) {
    PathTilt law = tilt;
    if (!add_functional(motion, weights, law.functionals)) continue;
    law.centre.conservativeResize(count + 1);
    law.spreads.conservativeResize(count + 1);
    law.centre[count] = 0.0;
    law.spreads[count] = 1.0;
    directions.push_back({std::move(law), count});
  }
  return directions;
}

/// The errors with the direction's functional held, averaged over a few places.
double held_errors(const PredictedMotion& motion, const Direction& direction, double spread,
                   const std::vector<SurrogateStage>& untilted) {
  double sum = 0.0;
  for (const double place : {-1.0, 0.0, 1.0}) {
    const PathTilt part = direction.part(place, spread);
    sum += relative_errors(affine_surrogates(motion, kCore, part), untilted) / 3.0;
  }
  return sum;
}

/// Number of parts.
double parts_of(double spread) { return static_cast<double>(tilt_grid(spread).places.size()); }

}  // namespace

TiltSplit best_split(const PredictedMotion& motion, const PathTilt& tilt,
                     const std::vector<SurrogateStage>& untilted, double most,
                     const Executor& run) {
  if (parts_of(kSpread) > most) return {};
  const std::vector<SurrogateStage> stages = affine_surrogates(motion, kCore, tilt);
  const std::vector<Direction> directions = directions_of(motion, tilt, stages);
  if (directions.empty()) return {};
  std::vector<double> errors(directions.size());
  run(static_cast<int>(directions.size()), [&](int i) {
    const auto index = static_cast<std::size_t>(i);
    errors[index] = held_errors(motion, directions[index], kSpread, untilted);
  });
  const auto least = std::min_element(errors.begin(), errors.end());
  if (!(*least < (1.0 - kLeastGain) * relative_errors(stages, untilted))) return {};
  const Direction& best = directions[static_cast<std::size_t>(least - errors.begin())];
  double spread = kSpread;
  for (int times = 0; times < 2; ++times) {
    const double nearer = kNarrowing * spread;
    if (parts_of(nearer) > most) break;
    const double left = held_errors(motion, best, nearer, untilted);
    if (!(left < (1.0 - kNarrowingGain) * *least)) break;
    *least = left;
    spread = nearer;
  }
  const TiltGrid grid = tilt_grid(spread);
  TiltSplit split{.parts = {}, .weights = grid.weights, .left_out = grid.left_out};
  for (const double place : grid.places) split.parts.push_back(best.part(place, spread));
  return split;
}

}  // namespace qsmpc::controller
