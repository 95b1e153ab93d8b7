#include "controller/certification/first_entry.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

#include <Eigen/Core>

#include "controller/certification/disc_surrogate.hpp"
#include "controller/measure/normal/bivariate_normal.hpp"
#include "controller/measure/normal/norm_orders.hpp"
#include "controller/measure/normal/normal_distribution.hpp"
#include "models/constants.hpp"

namespace qsmpc::controller {
namespace {

// A region whose shares sum to less than this over all stages is not refined.
constexpr double kNegligibleEntry = 1e-8;
// Sizes of errors to try, relative to their norms: each gives a bound.
constexpr int kSizes = 20;
constexpr double kLeastSize = 1.2;
constexpr double kSizeRatio = 1.25;
// By the norm of highest order, errors above this size have negligible probability.
constexpr double kSafeSize = 10.0;

/// The surrogates of a disc's centre at stages 1 …, and its covariance with the previous stage.
struct DiscPath {
  std::vector<DiscSurrogate> stages;
  std::vector<Eigen::MatrixXd> with_last;  ///< Cov(centre, centre of the stage before)
};

DiscPath disc_path(const std::vector<SurrogateStage>& surrogates, std::size_t known,
                   const DiscPlacement& placement) {
  DiscPath path;
  for (std::size_t k = 1; k <= known; ++k) {
    path.stages.push_back(disc_surrogate(surrogates[k], placement));
    Eigen::MatrixXd with_last = surrogates[k].with_last;
    const Eigen::MatrixXd& turn = path.stages.back().turn;
    if (turn.size() > 0) with_last = turn * with_last;
    if (k > 1 && turn.size() > 0) {
      with_last = (with_last * path.stages[k - 2].turn.transpose()).eval();
    }
    path.with_last.push_back(std::move(with_last));
  }
  return path;
}

/// The event that n·z reaches a threshold. Otherwise n·x is in the half-space with a probability of
/// at most `rest`.
struct Crossing {
  double mean = 0.0;
  double variance = 0.0;
  double threshold = 0.0;
  double rest = 0.0;
  double beyond = 1.0;  ///< P(n·z ≥ threshold)
};

/// ratio^−order of all sizes, for each of kHigherOrders.
std::array<std::array<double, kSizes>, kHigherOrders.size()> rests_of_sizes() {
  std::array<std::array<double, kSizes>, kHigherOrders.size()> rests{};
  for (std::size_t k = 0; k < kHigherOrders.size(); ++k) {
    double ratio = kLeastSize;
    for (double& rest : rests[k]) {
      rest = std::pow(ratio, -kHigherOrders[k]);
      ratio *= kSizeRatio;
    }
  }
  return rests;
}

double beyond_probability(double mean, double deviation, double threshold) {
  if (deviation > 0.0) return normal_cumulative((mean - threshold) / deviation);
  return mean >= threshold ? 1.0 : 0.0;
}

/// Bounds ‖n·e‖ by norms of e's coordinates. An unknown coordinate does not matter where n is zero
/// in it.
double norm_along(const Eigen::VectorXd& n, const Eigen::VectorXd& norms) {
  double sum = 0.0;
  for (Eigen::Index i = 0; i < n.size(); ++i) {
    if (n[i] != 0.0) sum += std::abs(n[i]) * norms[i];
  }
  return sum;
}

/// The crossing of `space` with that size of the error, out of a few, that gives the least bound
/// for the stage by itself.
Crossing crossing(const DiscSurrogate& centre, const HalfSpace& space) {
  const Eigen::VectorXd& n = space.normal;
  Crossing least{.mean = n.dot(centre.law.mean),
                 .variance = std::max(0.0, n.dot(centre.law.covariance * n)),
                 .threshold = -kInfinity};
  const double deviation = std::sqrt(least.variance);
  double value = kInfinity;
  const auto try_size = [&](double size, double rest) {
    const double threshold = space.offset - size;
    const double beyond = beyond_probability(least.mean, deviation, threshold);
    if (!(rest + beyond < value)) return;
    value = rest + beyond;
    least.threshold = threshold;
    least.rest = rest;
    least.beyond = beyond;
  };
  static const auto rests = rests_of_sizes();
  constexpr std::size_t kHighest = kHigherOrders.size() - 1;
  for (std::size_t k = kHigherOrders.size(); k-- > 0;) {
    const double norm = norm_along(n, centre.higher[k]);
    if (norm == 0.0) {
      try_size(0.0, 0.0);
      break;
    }
    if (!std::isfinite(norm)) continue;
    if (k == kHighest) try_size(kSafeSize * norm, std::pow(kSafeSize, -kHigherOrders[k]));
    if (value <= 2.0 * kNegligibleEntry) break;
    double ratio = kLeastSize;
    for (const double rest : rests[k]) {
      try_size(ratio * norm, rest);
      ratio *= kSizeRatio;
    }
  }
  return least;
}

/// P(n·z ≥ its threshold now, and below its threshold at the previous stage).
double entering_probability(const Crossing& now, const Crossing& before, double covariance) {
  Eigen::Matrix2d law;
  law << now.variance, covariance, covariance, before.variance;
  const double both =
      rectangle_probability({now.mean, before.mean}, law, {now.threshold, -kInfinity},
                            {kInfinity, before.threshold}) +
      rectangle_error(law);
  return std::min(now.beyond, both);
}

/// Per stage, bounds from a cover of a region by half-spaces: on the probability of being in one of
/// them, whatever came before (`anew`), and of entering one from outside of it at the previous
/// stage (`after`).
struct EntryTable {
  Eigen::VectorXd anew;
  Eigen::VectorXd after;
};

EntryTable entry_table(const DiscPath& path, const UnsafeRegion& region,
                       const Eigen::VectorXd& towards) {
  const auto count = static_cast<Eigen::Index>(path.stages.size());
  EntryTable table{.anew = Eigen::VectorXd::Constant(count, kInfinity),
                   .after = Eigen::VectorXd::Constant(count, kInfinity)};
  std::vector<Crossing> before;
  std::vector<HalfSpace> spaces_before;
  for (Eigen::Index k = 0; k < count; ++k) {
    const auto index = static_cast<std::size_t>(k);
    std::vector<Crossing> now;
    std::vector<HalfSpace> spaces = region.half_space_cover(k + 1, towards);
    now.reserve(spaces.size());
    for (const HalfSpace& space : spaces) now.push_back(crossing(path.stages[index], space));
    if (!now.empty()) table.anew[k] = 0.0;
    if (!now.empty() && now.size() == before.size()) table.after[k] = 0.0;
    for (std::size_t i = 0; i < now.size(); ++i) {
      table.anew[k] += now[i].rest + now[i].beyond;
      if (now.size() != before.size()) continue;
      const double covariance =
          spaces[i].normal.dot(path.with_last[index] * spaces_before[i].normal);
      table.after[k] += now[i].rest + entering_probability(now[i], before[i], covariance);
    }
    before = std::move(now);
    spaces_before = std::move(spaces);
  }
  return table;
}

/// Covers each stage either by its own bound or by the half-spaces, which cost only `after` where
/// they also cover the previous stage, so that the sum is least.
Eigen::VectorXd least_cover(const Eigen::VectorXd& single, const EntryTable& table) {
  const Eigen::Index count = single.size();
  Eigen::Matrix2Xd costs(2, count);                              // by itself, by half-spaces
  Eigen::Matrix<bool, 2, Eigen::Dynamic> from_spaces(2, count);  // the previous stage's choice
  const auto before = [&](Eigen::Index row, Eigen::Index k) {
    return k > 0 ? costs(row, k - 1) : row == 0 ? 0.0 : kInfinity;
  };
  for (Eigen::Index k = 0; k < count; ++k) {
    from_spaces(0, k) = before(1, k) < before(0, k);
    costs(0, k) = std::min(before(0, k), before(1, k)) + single[k];
    const double anew = before(0, k) + table.anew[k];
    const double after = before(1, k) + table.after[k];
    from_spaces(1, k) = after < anew;
    costs(1, k) = std::min(anew, after);
  }
  Eigen::VectorXd cover(count);
  bool spaces = count > 0 && costs(1, count - 1) < costs(0, count - 1);
  for (Eigen::Index k = count; k-- > 0;) {
    const bool spaces_before = from_spaces(spaces ? 1 : 0, k);
    cover[k] = !spaces ? single[k] : spaces_before ? table.after[k] : table.anew[k];
    spaces = spaces_before;
  }
  return cover;
}

/// The direction that leads into the region fastest from the disc's expected place at `stage`.
Eigen::VectorXd direction_into(const UnsafeRegion& region, const DiscPath& path,
                               Eigen::Index stage) {
  const Eigen::VectorXd& mean = path.stages[static_cast<std::size_t>(stage)].law.mean;
  NearestFaces nearest{.distance = Eigen::ArrayXd::Constant(1, kInfinity),
                       .slope = Points::Zero(mean.size(), 1)};
  region.lower_to_faces(stage + 1, Points(mean), nearest);
  return -nearest.slope.col(0);
}

}  // namespace

std::vector<double> first_entry_bounds(const UnsafeSet& unsafe, const SurrogateBounds& of) {
  const std::vector<SurrogateStage>& surrogates = of.surrogates;
  std::vector<double> entries(of.bounds.size(), 1.0);
  std::size_t known = 0;
  while (known + 1 < surrogates.size() && surrogates[known + 1].leaving < 1.0) ++known;
  const auto count = static_cast<Eigen::Index>(known);
  Eigen::VectorXd total(count);
  for (std::size_t k = 0; k < known; ++k) {
    // The events of leaving grow from stage to stage.
    total[static_cast<Eigen::Index>(k)] =
        surrogates[k + 1].leaving - (k > 0 ? surrogates[k].leaving : 0.0);
  }
  Eigen::Index part = 0;
  for (const DiscView& disc : unsafe.discs()) {
    DiscPath path;
    for (const RegionPointer& region : disc.regions) {
      const Eigen::VectorXd single = of.shares.row(part++).head(count);
      if (single.sum() <= kNegligibleEntry) {
        total += single;
        continue;
      }
      if (path.stages.empty()) path = disc_path(surrogates, known, disc.placement);
      Eigen::Index nearest = 0;
      single.maxCoeff(&nearest);
      total +=
          least_cover(single, entry_table(path, *region, direction_into(*region, path, nearest)));
    }
  }
  // NaN is not a bound.
  for (std::size_t k = 0; k < known; ++k) {
    const double entry = total[static_cast<Eigen::Index>(k)];
    entries[k] = entry >= 0.0 && entry < 1.0 ? entry : 1.0;
  }
  return entries;
}

}  // namespace qsmpc::controller
