#include "tests/support/plain_mixture.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "models/constants.hpp"
#include "models/linear_algebra.hpp"

namespace qsmpc::testing {
namespace {
// The constants of the split (mixture_split.cpp).
constexpr double kLeastRatio = 2.0;
constexpr double kMostRatio = 16.0;
constexpr double kNoSpread = 1e-14;
constexpr double kNoMass = 1e-12;
constexpr int kDroppedBits = 6;

struct Interval {
  double lower = -kInfinity;
  double upper = kInfinity;
};

/// ∫ of 1, x and x² over an interval of z, for x = y + σ z.
struct Integrals {
  double probability;
  double first;
  double second;
};

double below(double z) { return 0.5 * std::erfc(-z / std::numbers::sqrt2); }
double density(double z) { return std::exp(-0.5 * z * z) / std::sqrt(2.0 * std::numbers::pi); }
double times_density(double z) { return std::isinf(z) ? 0.0 : z * density(z); }

/// P(z in the interval), without cancellation in the tails.
double probability_of(const Interval& z) {
  return z.lower > 0.0 ? below(-z.lower) - below(-z.upper) : below(z.upper) - below(z.lower);
}

Integrals integrals_over(const Interval& z, double y, double deviation) {
  const double probability = probability_of(z);
  const double fall = density(z.lower) - density(z.upper);
  const double square = probability + times_density(z.lower) - times_density(z.upper);
  return {probability, y * probability + deviation * fall,
          y * y * probability + 2.0 * y * deviation * fall + deviation * deviation * square};
}

/// A box of one source's noise, in the noise's axes and standard deviations.
struct Piece {
  int source = 0;
  std::vector<Interval> box;
};

struct Cell {
  std::vector<Piece> pieces;
  double mass = 0.0;
  int axis = -1;  // axis to split along; −1: not to be split
  double at = 0.0;
  double spread = 0.0;
  std::uint32_t key = 0;
};

class PlainSplit {
 public:
  PlainSplit(const Eigen::MatrixXd& covariance, int cells, int parts,
             const controller::Points& sources, const Eigen::VectorXd& weights)
      : limit_(cells), least_share_(1.0 / parts), weights_(weights) {
    const models::SymmetricEigen eigen = models::symmetric_eigen(covariance);
    axes_ = eigen.vectors;
    deviations_ = eigen.values.cwiseMax(0.0).cwiseSqrt();
    centre_ = sources * weights;
    positions_ = axes_.transpose() * (sources.colwise() - centre_);
    second_moment_ = (positions_.array().square().matrix() * weights).sum() +
                     deviations_.squaredNorm() * weights.sum();
  }

  PlainMixture run() {
    Cell whole;
    for (int i = 0; i < weights_.size(); ++i) {
      if (weights_[i] > 0.0) whole.pieces.push_back({i, std::vector<Interval>(dim())});
    }
    choose_axis(whole);
    cells_.push_back(whole);
    while (cut_round()) {
    }
    return finished();
  }

 private:
  [[nodiscard]] int dim() const { return static_cast<int>(deviations_.size()); }

  [[nodiscard]] Integrals along(const Piece& piece, int axis) const {
    return integrals_over(piece.box[axis], positions_(axis, piece.source), deviations_[axis]);
  }

  /// Probability of the box along all axes but one (−1: all).
  [[nodiscard]] double share_without(const Piece& piece, int axis) const {
    double share = 1.0;
    for (int a = 0; a < dim(); ++a) share *= a == axis ? 1.0 : probability_of(piece.box[a]);
    return share;
  }

  void choose_axis(Cell& cell) const {
    cell.mass = 0.0;
    cell.axis = -1;
    cell.key = 0;
    for (const Piece& piece : cell.pieces) {
      cell.mass += weights_[piece.source] * share_without(piece, -1);
    }
    for (int axis = 0; axis < dim(); ++axis) {
      double first = 0.0;
      double second = 0.0;
      for (const Piece& piece : cell.pieces) {
        const double scale = weights_[piece.source] * share_without(piece, axis);
        const Integrals values = along(piece, axis);
        first += scale * values.first;
        second += scale * values.second;
      }
      const double mean = first / cell.mass;
      const double spread = (second - mean * first) / second_moment_;
      if (!(spread > kNoSpread)) continue;
      const std::uint32_t key = rounded(spread);
      if (cell.axis >= 0 && key <= cell.key) continue;
      cell.axis = axis;
      cell.at = mean;
      cell.spread = spread;
      cell.key = key;
    }
  }

  static std::uint32_t rounded(double spread) {
    return std::bit_cast<std::uint32_t>(static_cast<float>(spread)) >> kDroppedBits;
  }

  /// Splits all cells whose spread exceeds a fraction of the largest spread, until their pieces
  /// fall below it, within limits. If there are more such cells than remaining splits, only the
  /// widest ones are split, once each.
  bool cut_round() {
    const auto left = static_cast<std::size_t>(limit_) - cells_.size();
    const Cell* widest = nullptr;
    for (const Cell& cell : cells_) {
      if (cell.axis >= 0 && (widest == nullptr || cell.key > widest->key)) widest = &cell;
    }
    if (left == 0 || widest == nullptr) return false;
    const double ratio =
        std::clamp(limit_ / static_cast<double>(cells_.size()), kLeastRatio, kMostRatio);
    const std::uint32_t least = rounded(widest->spread / ratio);
    std::vector<std::size_t> round;
    for (std::size_t n = 0; n < cells_.size(); ++n) {
      if (cells_[n].axis >= 0 && cells_[n].key >= least) round.push_back(n);
    }
    std::size_t most = 1 + left / round.size();
    if (round.size() >= left) {
      most = 2;
      std::stable_sort(round.begin(), round.end(),
                       [&](std::size_t a, std::size_t b) { return cells_[a].key > cells_[b].key; });
      round.resize(left);
      std::sort(round.begin(), round.end());
    }
    // Backwards, so that the remaining indices stay valid.
    std::for_each(round.rbegin(), round.rend(), [&](std::size_t n) { refine(n, least, most); });
    return true;
  }

  /// Splits cell `n` and its pieces, lower ones first, into at most `most` cells.
  void refine(std::size_t n, std::uint32_t least, std::size_t most) {
    std::size_t pieces = 1;
    for (std::size_t at = n; at < n + pieces; ++at) {
      while (pieces < most && cells_[at].axis >= 0 && cells_[at].key >= least && split(at))
        ++pieces;
    }
  }

  /// Where to cut the piece: at the cell's mean, or not at all if one part would be too small.
  [[nodiscard]] double cut_of(const Piece& piece, int axis, double at) const {
    const Interval own = piece.box[axis];
    const double away = at - positions_(axis, piece.source);
    const double deviation = deviations_[axis];
    const double z = deviation > 0.0 ? away / deviation
                     : away == 0.0   ? 0.0
                                     : std::copysign(kInfinity, away);
    const double others = share_without(piece, axis);
    const double lower = below(z) - below(own.lower);
    const double upper = below(own.upper) - below(z);
    if (others * lower >= least_share_ && others * upper >= least_share_) return z;
    return lower >= upper ? own.upper : own.lower;
  }

  /// The lower half replaces the cell and the upper half follows it. False if either is empty.
  bool split(std::size_t index) {
    const Cell& cell = cells_[index];
    Cell lower;
    Cell upper;
    for (const Piece& piece : cell.pieces) {
      const double z = cut_of(piece, cell.axis, cell.at);
      Piece part = piece;
      part.box[cell.axis].upper = z;
      if (part.box[cell.axis].lower < z) lower.pieces.push_back(part);
      part = piece;
      part.box[cell.axis].lower = z;
      if (z < part.box[cell.axis].upper) upper.pieces.push_back(part);
    }
    choose_axis(lower);
    choose_axis(upper);
    const double least = kNoMass * cell.mass;
    if (!(lower.mass > least && upper.mass > least)) {
      cells_[index].axis = -1;
      return false;
    }
    cells_[index] = lower;
    cells_.insert(cells_.begin() + static_cast<std::ptrdiff_t>(index) + 1, upper);
    return true;
  }

  [[nodiscard]] PlainCell finished_cell(const Cell& cell) const {
    PlainCell out;
    Eigen::VectorXd noise = Eigen::VectorXd::Zero(dim());
    Eigen::VectorXd first = Eigen::VectorXd::Zero(dim());
    Eigen::MatrixXd second = Eigen::MatrixXd::Zero(dim(), dim());
    for (const Piece& piece : cell.pieces) {
      const double mass = weights_[piece.source] * share_without(piece, -1);
      Eigen::VectorXd mean(dim());  // given the piece
      Eigen::VectorXd variance(dim());
      for (int a = 0; a < dim(); ++a) {
        const Integrals values = along(piece, a);
        mean[a] = values.first / values.probability;
        variance[a] = values.second / values.probability - mean[a] * mean[a];
      }
      out.parts.push_back({piece.source, mass});
      out.weight += mass;
      first += mass * mean;
      noise += mass * (mean - positions_.col(piece.source));
      second += mass * (mean * mean.transpose());
      second.diagonal() += mass * variance;
    }
    const Eigen::VectorXd mean = first / out.weight;
    out.noise_mean = axes_ * noise / out.weight;
    out.mean = centre_ + axes_ * mean;
    out.covariance = axes_ * (second / out.weight - mean * mean.transpose()) * axes_.transpose();
    return out;
  }

  [[nodiscard]] PlainMixture finished() const {
    PlainMixture mixture;
    double cost = 0.0;
    for (const Cell& cell : cells_) {
      mixture.cells.push_back(finished_cell(cell));
      cost += mixture.cells.back().weight * mixture.cells.back().covariance.trace();
    }
    mixture.w2 = std::sqrt(std::max(0.0, cost));
    return mixture;
  }

  int limit_;
  double least_share_;
  const Eigen::VectorXd& weights_;
  Eigen::MatrixXd axes_;
  Eigen::VectorXd deviations_;
  Eigen::VectorXd centre_;
  Eigen::MatrixXd positions_;  // of the sources relative to their mean, in the noise's axes
  double second_moment_ = 0.0;
  std::vector<Cell> cells_;
};

}  // namespace

PlainMixture plain_split(const Eigen::MatrixXd& covariance, int cells, int parts,
                         const controller::Points& sources, const Eigen::VectorXd& weights) {
  return PlainSplit(covariance, cells, parts, sources, weights).run();
}

}  // namespace qsmpc::testing
