#include "controller/measure/quantisation/gaussian_quantiser.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>

#include "controller/measure/quantisation/normal_lloyd.hpp"
#include "controller/measure/quantisation/normal_quantiser.hpp"
#include "controller/named_entry.hpp"
#include "models/linear_algebra.hpp"

namespace qsmpc::controller {
namespace {

// W2² of Lloyd's points over that of a grid of as many points, with the same, possibly fractional,
// number of levels on every axis: between 0.79 and 0.93 for 100 to 1000 points in 2 to 6
// dimensions. It only guides a choice.
constexpr double kExpectedGain = 0.85;

/// Depth-first search over the levels of axes sorted by falling variance. Since D(n) ≥ n⁻², the
/// distortion of a Gaussian at rate log n, s further axes with variances v cost at least
/// s (Π v)^(1/s) (Π n)^(−2/s). This excludes levels that leave too little for them.
class LevelSearch {
 public:
  LevelSearch(Eigen::VectorXd variances, int budget)
      : variances_(std::move(variances)),
        positive_((variances_.array() > 0.0).count()),
        cost_after_(positive_),
        current_(variances_.size(), 1) {
    double logarithms = 0.0;
    for (Eigen::Index axis = positive_ - 1; axis >= 0; --axis) {
      const auto axes = static_cast<double>(positive_ - axis - 1);
      cost_after_[axis] = axes > 0.0 ? axes * std::exp(logarithms / axes) : 0.0;
      logarithms += std::log(variances_[axis]);
    }
    guess(budget);
    visit(0, budget, budget, 0.0);
  }
  [[nodiscard]] const std::vector<int>& best() const { return best_; }

 private:
  // An initial shape for excluding others: the ideal real levels, rounded down in turn.
  void guess(int budget) {
    best_ = current_;
    best_error_ = 0.0;
    int left = budget;
    for (Eigen::Index axis = 0; axis < positive_; ++axis) {
      best_[axis] = std::min(left, ideal_level(axis, left));
      left /= best_[axis];
      best_error_ += variances_[axis] * approximate_distortion(best_[axis]);
    }
  }

  // Levels in proportion to the deviations, on as many axes as get more than one.
  [[nodiscard]] int ideal_level(Eigen::Index axis, int left) const {
    double least = left;
    double logarithms = 0.0;
    for (Eigen::Index next = axis + 1; next < positive_; ++next) {
      logarithms += std::log(variances_[next] / variances_[axis]);
      const auto axes = static_cast<double>(next - axis + 1);
      least = std::min(least, std::pow(left * std::exp(-0.5 * logarithms), 1.0 / axes));
    }
    return std::max(1, static_cast<int>(least));
  }

  // The largest level of an axis with which those after it, both the next one alone and all
  // together, can still cost less than `spare`.
  [[nodiscard]] int most_useful_level(Eigen::Index axis, int left, double spare) const {
    const double next = left * std::sqrt(spare / variances_[axis + 1]);
    const auto axes = static_cast<double>(positive_ - axis - 1);
    const double all = left * std::pow(spare / cost_after_[axis], 0.5 * axes);
    return static_cast<int>(std::min({static_cast<double>(left - 1), next, all})) + 1;
  }

  // `left`: what remains of the budget; `ceiling`: the level of the previous axis.
  void visit(Eigen::Index axis, int left, int ceiling, double error) {
    if (error >= best_error_) return;
    if (axis == positive_) {
      best_error_ = error;
      best_ = current_;
      return;
    }
    const bool last = axis + 1 == positive_;
    const int most =
        std::min(ceiling, last ? left : most_useful_level(axis, left, best_error_ - error));
    const int least = last ? most : 1;
    for (int level = most; level >= least; --level) {
      const double cost = error + variances_[axis] * approximate_distortion(level);
      if (cost >= best_error_) break;  // fewer levels cost more
      current_[axis] = level;
      visit(axis + 1, left / level, level, cost);
    }
    current_[axis] = 1;
  }

  Eigen::VectorXd variances_;
  Eigen::Index positive_;       // number of axes with variance; sorted, they come first
  Eigen::VectorXd cost_after_;  // the bound for all positive axes after each, with one point
  std::vector<int> current_;
  std::vector<int> best_;
  double best_error_ = std::numeric_limits<double>::infinity();
};

/// Points for some consecutive eigenaxes in units of their standard deviations.
struct Factor {
  Points points;            // k x n
  Eigen::VectorXd weights;  // n
  Eigen::MatrixXd lost;     // k x k, for unit variances
};

/// Points in the eigenbasis about the mean.
struct Standardised {
  Points points;            // d x n
  Eigen::VectorXd weights;  // n
  Eigen::MatrixXd lost;     // d x d
  std::vector<int> levels;  // of a product of one-dimensional quantisers; else empty
};

/// Optimal one-dimensional quantisers for the first axes, all but `left_out`.
std::vector<Factor> axis_factors(const std::vector<int>& levels, Eigen::Index left_out) {
  std::vector<Factor> factors;
  for (auto level = levels.begin(); level != levels.end() - left_out; ++level) {
    const NormalQuantiser& quantiser = normal_quantiser(*level);
    factors.push_back({.points = quantiser.points.transpose(),
                       .weights = quantiser.weights,
                       .lost = Eigen::MatrixXd::Constant(1, 1, quantiser.distortion)});
  }
  return factors;
}

/// The product measure of independent factors, whose axes follow one another.
Standardised product(const std::vector<Factor>& factors, const Eigen::VectorXd& variances) {
  Eigen::Index count = 1;
  for (const Factor& factor : factors) count *= factor.weights.size();
  const Eigen::Index dim = variances.size();
  Standardised result{.points = Points(dim, count),
                      .weights = Eigen::VectorXd::Ones(count),
                      .lost = Eigen::MatrixXd::Zero(dim, dim),
                      .levels = {}};
  const Eigen::VectorXd deviations = variances.cwiseSqrt();
  Eigen::Index axis = 0;
  Eigen::Index filled = 1;  // columns so far; those of one more factor are copies of them
  for (const Factor& factor : factors) {
    const Eigen::Index axes = factor.points.rows();
    const auto scale = deviations.segment(axis, axes);
    result.lost.block(axis, axis, axes, axes) =
        scale.asDiagonal() * factor.lost * scale.asDiagonal();
    for (Eigen::Index i = factor.weights.size() - 1; i >= 0; --i) {  // the first one last
      const Eigen::Index start = i * filled;
      if (i > 0) {
        result.points.block(0, start, axis, filled) = result.points.topLeftCorner(axis, filled);
      }
      result.points.block(axis, start, axes, filled).colwise() =
          scale.cwiseProduct(factor.points.col(i));
      result.weights.segment(start, filled) = factor.weights[i] * result.weights.head(filled);
    }
    axis += axes;
    filled *= factor.weights.size();
  }
  return result;
}

/// How many points are left for the last `leading` axes if the others keep their levels.
int points_to_spread(const std::vector<int>& levels, Eigen::Index leading, int budget) {
  return std::accumulate(levels.begin(), levels.end() - leading, budget,
                         [](int left, int level) { return left / level; });
}

/// D between the integers, interpolated linearly in log n and log D.
double distortion_between(double count) {
  const int below = static_cast<int>(count);
  const double part = std::log(count / below) / std::log1p(1.0 / below);
  return std::pow(approximate_distortion(below), 1.0 - part) *
         std::pow(approximate_distortion(below + 1), part);
}

/// The number of leading axes for which Lloyd's points promise the least W2; 1 if there is none.
Eigen::Index axes_to_spread(const Eigen::VectorXd& variances, const std::vector<int>& levels,
                            int budget) {
  const auto dim = variances.size();
  Eigen::Index best = 1;
  double least = 0.0;
  for (Eigen::Index j = 0; j < dim; ++j) least += variances[j] * approximate_distortion(levels[j]);
  double others = least;
  for (Eigen::Index leading = 1; leading <= std::min<Eigen::Index>(dim, kLloydDimensions);
       ++leading) {
    const Eigen::Index added = dim - leading;
    if (variances[added] <= 0.0) break;
    others -= variances[added] * approximate_distortion(levels[added]);
    const int count = points_to_spread(levels, leading, budget);
    if (leading < 2 || count < 2 || count > kLloydPoints) continue;
    const double cubes = distortion_between(std::pow(count, 1.0 / static_cast<double>(leading)));
    const double expected = others + kExpectedGain * variances.tail(leading).sum() * cubes;
    if (expected < least) {
      least = expected;
      best = leading;
    }
  }
  return best;
}

/// Levels on the first axes, Lloyd's points on the last `leading` ones.
std::vector<Factor> spread_factors(const std::vector<int>& levels, Eigen::Index leading,
                                   int budget) {
  std::vector<Factor> factors = axis_factors(levels, leading);
  const NormalLloyd& lloyd =
      normal_lloyd(static_cast<int>(leading), points_to_spread(levels, leading, budget));
  factors.push_back({.points = lloyd.measure.locations,
                     .weights = lloyd.measure.weights,
                     .lost = lloyd.within_covariance});
  return factors;
}

}  // namespace

std::vector<int> allot_levels(const Eigen::Ref<const Eigen::VectorXd>& variances, int budget) {
  if (budget < 1) throw std::invalid_argument("quantiser: the budget must be at least one point");
  if (!variances.allFinite() || (variances.array() < 0.0).any()) {
    throw std::invalid_argument("quantiser: variances must be finite and not negative");
  }
  std::vector<Eigen::Index> order(variances.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](auto a, auto b) { return variances[a] > variances[b]; });
  Eigen::VectorXd sorted(variances.size());
  for (std::size_t i = 0; i < order.size(); ++i) sorted[i] = variances[order[i]];
  const LevelSearch search(sorted, budget);
  std::vector<int> levels(order.size());
  for (std::size_t i = 0; i < order.size(); ++i) levels[order[i]] = search.best()[i];
  return levels;
}

const std::vector<QuantiserEntry>& quantisers() {
  static const std::vector<QuantiserEntry> table = {
      {"product", "grid of optimal points on each axis of the covariance; fast, W2 exact",
       QuantiserKind::kProduct},
      {"lloyd", "points placed by Lloyd's method: smaller W2, but a slow first call",
       QuantiserKind::kLloyd},
  };
  return table;
}

QuantiserKind quantiser_kind(std::string_view name) {
  return named_entry(quantisers(), name, "quantiser").kind;
}

GaussianQuantisation quantise(const Gaussian& gaussian, int budget, QuantiserKind kind) {
  check_gaussian(gaussian);
  const models::SymmetricEigen eigen = models::symmetric_eigen(gaussian.covariance);
  const Eigen::VectorXd variances = eigen.values.cwiseMax(0.0);
  const std::vector<int> levels = allot_levels(variances, budget);
  Standardised best = product(axis_factors(levels, 0), variances);
  best.levels = levels;
  if (kind == QuantiserKind::kLloyd) {
    const Eigen::Index leading = axes_to_spread(variances, levels, budget);
    if (leading > 1) {
      Standardised spread = product(spread_factors(levels, leading, budget), variances);
      if (spread.lost.trace() < best.lost.trace()) best = std::move(spread);
    }
  }
  const auto& basis = eigen.vectors;
  return {.measure = {.locations = (basis * best.points).colwise() + gaussian.mean,
                      .weights = std::move(best.weights)},
          .w2 = std::sqrt(best.lost.trace()),
          .within_covariance = basis * best.lost * basis.transpose(),
          .levels = std::move(best.levels)};
}

}  // namespace qsmpc::controller
