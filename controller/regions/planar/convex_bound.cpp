#include "controller/regions/planar/convex_bound.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <optional>
#include <span>

#include "controller/measure/normal/integer_power.hpp"
#include "controller/measure/normal/normal_distribution.hpp"
#include "controller/regions/box_part.hpp"
#include "controller/regions/planar/convex_surface.hpp"
#include "models/constants.hpp"

namespace qsmpc::controller {
namespace {

// Determinant of a covariance relative to the product of its variances: below this there is no
// second direction.
constexpr double kRegularShare = 1e-10;
// A correlation of projections up to this is rounding; they count as independent.
constexpr double kNoCorrelation = 1e-12;

Eigen::Vector2d across(const Eigen::Vector2d& direction) { return {-direction.y(), direction.x()}; }

bool is_regular(const Eigen::Matrix2d& covariance) {
  const double product = covariance(0, 0) * covariance(1, 1);
  return covariance.determinant() > kRegularShare * product;
}

/// The direction whose projection is uncorrelated with that on `direction`.
Eigen::Vector2d conjugate(const Eigen::Vector2d& direction, const Eigen::Matrix2d& covariance) {
  const Eigen::Vector2d other = across(covariance * direction);
  const double length = other.norm();
  return length > 0.0 ? Eigen::Vector2d(other / length) : across(direction);
}

DirectionPair pair_of(const Eigen::Vector2d& one, const Eigen::Vector2d& two) {
  DirectionPair pair;
  pair << one.transpose(), two.transpose();
  return pair;
}

/// The rectangle about the part in the projections.
BoxPart rectangle_about(const ConvexPart& part, const DirectionPair& pair) {
  BoxPart rectangle{.box = {.lower = Eigen::Vector2d::Constant(-kInfinity),
                            .upper = Eigen::Vector2d::Constant(kInfinity)},
                    .axes = {}};
  for (Eigen::Index i = 0; i < 2; ++i) {
    const Eigen::Vector2d direction = pair.row(i).transpose();
    rectangle.box.upper[i] = support(part, direction);
    rectangle.box.lower[i] = -support(part, -direction);
    const bool bounded =
        std::isfinite(rectangle.box.lower[i]) || std::isfinite(rectangle.box.upper[i]);
    if (bounded) rectangle.axes.push_back(i);
  }
  return rectangle;
}

/// The surrogate state of a disc's centre in two projections.
class ProjectedLaw {
 public:
  ProjectedLaw(const SurrogateLaw& state, PlaneAxes axes, const DirectionPair& pair)
      : pair_(pair), axes_({axes.x, axes.y}), state_(state) {
    law_.mean = pair * state.law.mean(axes_);
    law_.covariance = projected(state.law.covariance);
    error_ = pair.cwiseAbs() * state.error(axes_);
    for (std::size_t k = 0; k < kHigherOrders.size(); ++k) {
      higher_[k] = pair.cwiseAbs() * state.higher[k](axes_);
    }
    smoothing_ = [this](const std::vector<Eigen::Index>& /*axes*/) -> Eigen::MatrixXd {
      // Even a single projection depends on both coordinates.
      return projected(state_.smoothing(axes_));
    };
  }
  ProjectedLaw(const ProjectedLaw&) = delete;
  ProjectedLaw& operator=(const ProjectedLaw&) = delete;

  [[nodiscard]] SurrogateLaw surrogate(double useful) const {
    return {.law = law_,
            .error = error_,
            .higher = higher_,
            .smoothing = smoothing_,
            .worthwhile = state_.worthwhile,
            .wanted = state_.wanted,
            .useful = std::min(useful, state_.useful)};
  }

 private:
  [[nodiscard]] Eigen::MatrixXd projected(const Eigen::MatrixXd& covariance) const {
    const Eigen::Matrix2d plane = pair_ * covariance(axes_, axes_) * pair_.transpose();
    return 0.5 * (plane + plane.transpose());
  }

  DirectionPair pair_;
  std::vector<Eigen::Index> axes_;
  const SurrogateLaw& state_;
  Gaussian law_;
  Eigen::VectorXd error_;
  HigherNorms higher_;
  std::function<Eigen::MatrixXd(const std::vector<Eigen::Index>&)> smoothing_;
};

}  // namespace

DirectionPair nearest_pair(const ConvexPart& part, const Eigen::Vector2d& mean) {
  const Eigen::Vector2d out = nearest_surface(part, mean).outward;
  return pair_of(out, across(out));
}

std::vector<DirectionPair> other_pairs(const ConvexPart& part, const Eigen::Vector2d& mean,
                                       const Eigen::Matrix2d& covariance) {
  if (part.corners.cols() == 0 || !is_regular(covariance)) return {};
  const Eigen::Vector2d out = nearest_surface(part, mean).outward;
  std::vector<DirectionPair> pairs = {pair_of(out, conjugate(out, covariance))};
  const PlanarSeparation apart = separation(part, mean, covariance);
  const double length = apart.slope.norm();
  if (length > 0.0) {
    const Eigen::Vector2d shortest = apart.slope / length;
    pairs.push_back(pair_of(shortest, conjugate(shortest, covariance)));
    pairs.push_back(pair_of(shortest, across(shortest)));
  }
  return pairs;
}

// Let gap be the distance of the mean from the circle along u: z + e is in the circle only if u·z
// is at least gap/2 below its mean, or u·e is below −gap/2.
double far_probability(const SurrogateLaw& state, const Circle& circle, PlaneAxes axes,
                       const Eigen::Matrix2d& spread) {
  const Eigen::Vector2d way =
      Eigen::Vector2d(state.law.mean[axes.x], state.law.mean[axes.y]) - circle.centre;
  const double distance = way.norm();
  const double half = 0.5 * (distance - circle.radius);
  if (!(half > 0.0)) return 1.0;
  const Eigen::Vector2d u = way / distance;
  const Eigen::MatrixXd& covariance = state.law.covariance;
  const double variance = u.x() * u.x() * covariance(axes.x, axes.x) +
                          2.0 * u.x() * u.y() * covariance(axes.x, axes.y) +
                          u.y() * u.y() * covariance(axes.y, axes.y) + u.dot(spread * u);
  constexpr std::size_t kHighest = kHigherOrders.size() - 1;
  const Eigen::VectorXd& norms = state.higher[kHighest];
  const double norm = std::abs(u.x()) * norms[axes.x] + std::abs(u.y()) * norms[axes.y];
  const double tail = norm > 0.0 ? integer_power(norm / half, kHigherOrders[kHighest]) : 0.0;
  const double deviation = std::sqrt(std::max(0.0, variance));
  const double beyond =
      half > kTail * deviation ? kTailAllowance : normal_cumulative(-half / deviation);
  const double bound = tail + beyond;
  return bound < 1.0 ? bound : 1.0;  // NaN is no bound
}

RegionProbability convex_probability(const SurrogateLaw& state, const ConvexPart& part,
                                     PlaneAxes axes) {
  const std::vector<Eigen::Index> plane = {axes.x, axes.y};
  const Eigen::Vector2d mean = state.law.mean(plane);
  const Eigen::Matrix2d covariance = state.law.covariance(plane, plane);
  RegionProbability least{.markov = 1.0, .smooth = 1.0};
  if (!mean.allFinite() || !covariance.allFinite()) return least;
  const auto take = [&](const DirectionPair& pair) {
    const ProjectedLaw projected(state, axes, pair);
    RegionProbability bound;
    add_part_probability(projected.surrogate(least.smooth), rectangle_about(part, pair), bound);
    least.markov = std::min(least.markov, bound.markov);
    least.smooth = std::min({least.smooth, bound.smooth, least.markov});
  };
  take(nearest_pair(part, mean));
  // Other pairs cannot matter.
  const bool both = state.wanted == WantedBounds::kBoth;
  const double reached = both ? least.markov : least.smooth;
  if (reached <= std::max(state.worthwhile, kNegligiblePart)) return least;
  for (const DirectionPair& pair : other_pairs(part, mean, covariance)) take(pair);
  return least;
}

SoftPart soft_convex(const ConvexPart& part, const Eigen::Vector2d& mean,
                     const Eigen::Matrix2d& covariance) {
  SoftPart soft{.intervals = {}, .independent = false};
  const auto add = [&](const Eigen::Vector2d& direction) {
    const double at = direction.dot(mean);
    soft.intervals.push_back(
        {.lower = -support(part, -direction) - at,
         .upper = support(part, direction) - at,
         .deviation = std::sqrt(std::max(0.0, direction.dot(covariance * direction)))});
  };
  const Eigen::Vector2d out = nearest_surface(part, mean).outward;
  add(out);
  if (part.corners.cols() == 0) return soft;
  add(across(out));
  const double product = soft.intervals[0].deviation * soft.intervals[1].deviation;
  const double correlation = across(out).dot(covariance * out);
  soft.independent = std::abs(correlation) <= kNoCorrelation * product;
  if (soft.independent || !is_regular(covariance)) return soft;
  const PlanarSeparation apart = separation(part, mean, covariance);
  if (apart.slope.norm() > 0.0) add(apart.slope.normalized());
  return soft;
}

}  // namespace qsmpc::controller
