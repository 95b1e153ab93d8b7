#include "controller/measure/compression/compression.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <queue>
#include <stdexcept>

#include "controller/measure/compression/nearest_centre.hpp"

namespace qsmpc::controller {
namespace {

// The cost falls in every round, so that the rounds terminate; this guards against rounding.
constexpr int kRoundLimit = 10000;

/// A contiguous range of the permuted points, and the axis along which it spreads most.
struct Cell {
  int begin = 0;
  int end = 0;
  Eigen::Index axis = 0;
  double mean = 0.0;    // of the axis
  double spread = 0.0;  // Σ ρ (x − mean)² along the axis: the largest gain of a split

  // Ties are broken by position, so that the order of splits is the same on every platform.
  bool operator<(const Cell& other) const {
    return spread != other.spread ? spread < other.spread : begin > other.begin;
  }
};

Cell make_cell(const DiscreteMeasure& measure, const std::vector<int>& order, int begin, int end) {
  Cell cell{.begin = begin, .end = end};
  for (Eigen::Index axis = 0; axis < measure.dim(); ++axis) {
    double mass = 0.0;
    double first = 0.0;
    for (int k = begin; k < end; ++k) {
      const int i = order[k];
      mass += measure.weights[i];
      first += measure.weights[i] * measure.locations(axis, i);
    }
    if (mass <= 0.0) return cell;
    const double mean = first / mass;
    double spread = 0.0;
    for (int k = begin; k < end; ++k) {
      const double offset = measure.locations(axis, order[k]) - mean;
      spread += measure.weights[order[k]] * offset * offset;
    }
    if (spread > cell.spread) {
      cell.axis = axis;
      cell.mean = mean;
      cell.spread = spread;
    }
  }
  return cell;
}

/// Assigns every point to one of at most `count` cells of a recursive split.
std::vector<int> split_cells(const DiscreteMeasure& measure, int count, int& used) {
  const int size = static_cast<int>(measure.size());
  std::vector<int> order(size);
  std::iota(order.begin(), order.end(), 0);
  std::priority_queue<Cell> cells;
  cells.push(make_cell(measure, order, 0, size));
  while (static_cast<int>(cells.size()) < count && cells.top().spread > 0.0) {
    const Cell cell = cells.top();
    const auto middle =
        std::stable_partition(order.begin() + cell.begin, order.begin() + cell.end,
                              [&](int i) { return measure.locations(cell.axis, i) < cell.mean; });
    const int cut = static_cast<int>(middle - order.begin());
    if (cut == cell.begin || cut == cell.end) break;  // spread is rounding only
    cells.pop();
    cells.push(make_cell(measure, order, cell.begin, cut));
    cells.push(make_cell(measure, order, cut, cell.end));
  }
  used = static_cast<int>(cells.size());
  std::vector<int> assignment(size);
  for (int cluster = 0; !cells.empty(); ++cluster, cells.pop()) {
    for (int k = cells.top().begin; k < cells.top().end; ++k) assignment[order[k]] = cluster;
  }
  return assignment;
}

/// Masses and means of the clusters; a cluster without mass is dropped and the rest renumbered.
void update_clusters(const DiscreteMeasure& measure, int clusters, Compression& result) {
  Eigen::VectorXd mass = Eigen::VectorXd::Zero(clusters);
  Points moment = Points::Zero(measure.dim(), clusters);
  for (Eigen::Index i = 0; i < measure.size(); ++i)
    mass[result.assignment[i]] += measure.weights[i];
  for (Eigen::Index axis = 0; axis < measure.dim(); ++axis) {
    for (Eigen::Index i = 0; i < measure.size(); ++i) {
      moment(axis, result.assignment[i]) += measure.weights[i] * measure.locations(axis, i);
    }
  }
  std::vector<int> renumbered(clusters, 0);
  int kept = 0;
  for (int n = 0; n < clusters; ++n) {
    if (mass[n] > 0.0) renumbered[n] = kept++;
  }
  result.measure.weights.resize(kept);
  result.measure.locations.resize(measure.dim(), kept);
  for (int n = 0; n < clusters; ++n) {
    if (mass[n] <= 0.0) continue;
    result.measure.weights[renumbered[n]] = mass[n];
    result.measure.locations.col(renumbered[n]) = moment.col(n) / mass[n];
  }
  if (kept < clusters) {
    for (int& cluster : result.assignment) cluster = renumbered[cluster];
  }
}

/// Lloyd's method: at most `rounds` rounds of reassignment to the nearest mean, fewer if no point
/// moves any more.
void refine(const DiscreteMeasure& measure, int rounds, Compression& result) {
  const Eigen::MatrixXd points = measure.locations;
  NearestCentre nearest(points);
  for (int round = 0; round < rounds; ++round) {
    if (nearest.assign(result.measure.locations, result.assignment) == 0) return;
    update_clusters(measure, static_cast<int>(result.measure.size()), result);
  }
}

}  // namespace

Compression compress(const DiscreteMeasure& measure, int count, int refinements) {
  check_measure(measure);
  if (count < 1) throw std::invalid_argument("compression: at least one point must be kept");
  if (refinements < 0) throw std::invalid_argument("compression: refinements must not be negative");
  Compression result;
  int clusters = 0;
  result.assignment = split_cells(measure, count, clusters);
  update_clusters(measure, clusters, result);
  // With a cluster for every point there is nothing to refine.
  if (refinements > 0 && result.measure.size() < measure.size()) {
    refine(measure, std::min(refinements, kRoundLimit), result);
  }
  Points offsets(measure.dim(), measure.size());
  for (Eigen::Index i = 0; i < measure.size(); ++i) {
    offsets.col(i) = measure.locations.col(i) - result.measure.locations.col(result.assignment[i]);
  }
  result.within_covariance = offsets * measure.weights.asDiagonal() * offsets.transpose();
  result.w2 = std::sqrt(result.within_covariance.trace());
  return result;
}

}  // namespace qsmpc::controller
