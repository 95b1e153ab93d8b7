#include "controller/certification/smoothed_bound.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <vector>

#include "controller/regions/soft_part.hpp"
#include "models/constants.hpp"

namespace qsmpc::controller {
namespace {

// t is searched over radius · 1.02 … radius · 1.02 · 2^kOctaves, then about the best of these.
constexpr int kOctaves = 24;
constexpr int kBisections = 5;

/// E(1 − d(y, U)²/t²)₊ of a Gaussian mixture, by blocks of its centres.
class SoftMixture {
 public:
  SoftMixture(const GaussianMixture& mixture, const UnsafeSet& unsafe, Eigen::Index stage)
      : mixture_(mixture), discs_(unsafe.discs().size()) {
    for (std::size_t n = 0; n < discs_.size(); ++n) {
      const DiscView& view = unsafe.discs()[n];
      Disc& disc = discs_[n];
      const bool moves = !view.placement.at_position();
      if (moves) view.placement.of(mixture.centres, {0, mixture.centres.cols()}, disc.moved);
      const Points& points = moves ? disc.moved : mixture.centres;
      disc.lowest = points.rowwise().minCoeff();
      disc.highest = points.rowwise().maxCoeff();
      const GaussianCentres centres{.centres = points,
                                    .covariance = mixture.covariance,
                                    .lowest = disc.lowest,
                                    .highest = disc.highest};
      for (const RegionPointer& region : view.regions) {
        disc.regions.push_back(region->soften(stage, centres));
      }
    }
  }

  /// An upper bound of the value, or a partial sum of it as soon as that is at least `enough`.
  /// 0 < t.
  [[nodiscard]] double value(double t, double enough = kInfinity) const {
    const Eigen::Index size = mixture_.centres.cols();
    double sum = 0.0;
    // If a partial sum may be enough, that of the first few centres may be.
    Eigen::Index block = std::isinf(enough) ? kSoftBlock : kFirstBlock;
    for (Eigen::Index begin = 0; begin < size && sum < enough; begin += block) {
      if (begin > 0) block = kSoftBlock;
      const Eigen::Index count = std::min(block, size - begin);
      std::array<double, kSoftBlock> total{};
      for (const Disc& disc : discs_) {
        for (const auto& region : disc.regions) region->add(t, begin, count, total.data());
      }
      for (Eigen::Index i = 0; i < count; ++i) {
        sum += mixture_.weights[begin + i] * std::min(1.0, total[i]);
      }
    }
    return sum;
  }

 private:
  static constexpr Eigen::Index kFirstBlock = 8;

  /// A disc of the body, moved to each of the mixture's centres; `regions` refer to the other
  /// members.
  struct Disc {
    Points moved;
    Eigen::VectorXd lowest;
    Eigen::VectorXd highest;
    std::vector<std::unique_ptr<const SoftRegion>> regions;
  };

  const GaussianMixture& mixture_;
  std::vector<Disc> discs_;
};

/// Bounds √E|e|² for the difference e between each disc's centre and the one turned by the
/// mixture's centres only: the error of the state, and the effect of the heading's noise on the
/// disc, o √E|e^{iw} − 1|² (docs/theory/certificates.md, section 5).
double radius_of_discs(const GaussianMixture& mixture, const UnsafeSet& unsafe, double radius) {
  if (unsafe.reach() == 0.0) return radius;
  const int heading = unsafe.body().heading;
  const double variance = std::max(0.0, mixture.covariance(heading, heading));
  return unsafe.lipschitz() * radius +
         unsafe.reach() * std::sqrt(-2.0 * std::expm1(-0.5 * variance));
}

/// The value summed centre by centre, with allowances that also hold for the smallest t.
double precise_value(const GaussianMixture& mixture, const UnsafeSet& unsafe, double t,
                     Eigen::Index stage) {
  double sum = 0.0;
  for (Eigen::Index i = 0; i < mixture.centres.cols(); ++i) {
    if (mixture.weights[i] == 0.0) continue;
    sum += mixture.weights[i] *
           soft_unsafe_probability(mixture.centres.col(i), mixture.covariance, unsafe, t, stage);
  }
  return sum;
}

}  // namespace

double soft_unsafe_probability(const Eigen::Ref<const Eigen::VectorXd>& mean,
                               const Eigen::Ref<const Eigen::MatrixXd>& covariance,
                               const UnsafeSet& unsafe, double t, Eigen::Index stage) {
  double sum = 0.0;
  for (const DiscView& disc : unsafe.discs()) {
    const Eigen::VectorXd centre = disc.placement.of(mean);
    for (const RegionPointer& region : disc.regions) {
      sum += region->soft_probability(stage, centre, covariance, t);
    }
  }
  return std::min(1.0, sum);
}

double smoothed_probability(const GaussianMixture& mixture, const UnsafeSet& unsafe,
                            double state_radius, double useful_below, Eigen::Index stage) {
  const double radius = radius_of_discs(mixture, unsafe, state_radius);
  if (!std::isfinite(radius) || !mixture.centres.allFinite()) return 1.0;
  if (radius == 0.0) return precise_value(mixture, unsafe, kSmallestReach, stage);
  // A value below `useful_below` needs radius²/t² below it, hence a t beyond this one; and the
  // spread grows with t.
  const double useful = std::clamp(useful_below, kTailAllowance, 1.0);
  const double first = radius / std::sqrt(useful);
  const SoftMixture soft(mixture, unsafe, stage);
  if (soft.value(first, useful) >= useful) return 1.0;
  double best_t = first;
  double best = 1.0;
  const auto evaluate = [&](double t) {
    const double spread = soft.value(t);
    const double here = radius * radius / (t * t) + spread;
    if (here < best) {
      best = here;
      best_t = t;
    }
    return spread;
  };
  double t = 1.02 * first;
  for (int octave = 0; octave <= kOctaves; ++octave, t *= 2.0) {
    if (evaluate(t) >= std::min(best, useful)) break;  // no larger t can be better
  }
  double ratio = std::sqrt(2.0);
  for (int step = 0; step < kBisections; ++step, ratio = std::sqrt(ratio)) {
    const double centre = best_t;
    evaluate(centre / ratio);
    if (best_t == centre) evaluate(centre * ratio);
  }
  return std::min(1.0, best);
}

}  // namespace qsmpc::controller
