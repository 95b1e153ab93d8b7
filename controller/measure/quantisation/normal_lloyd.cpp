#include "controller/measure/quantisation/normal_lloyd.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <mutex>
#include <numeric>
#include <stdexcept>
#include <utility>
#include <vector>

#include "controller/measure/compression/compression.hpp"
#include "controller/measure/compression/nearest_centre.hpp"
#include "controller/measure/quantisation/normal_quantiser.hpp"
#include "models/linear_algebra.hpp"

namespace qsmpc::controller {
namespace {

// Cells of the grids per requested point. Most rounds are spent on the coarse grid; the fine one
// reduces the cost of the staircase of cells along the clusters' borders.
constexpr double kCoarseCells = 120.0;
constexpr double kFineCells = 600.0;
constexpr double kFewestCoarseCells = 2e4;
constexpr double kFewestFineCells = 3e5;
constexpr double kMostFineCells = 1e6;
// Work on a grid ends when a round lowers W2² by less than this share.
constexpr double kCoarseGain = 1e-4;
constexpr double kFineGain = 1e-3;
constexpr int kLongestDescent = 1000;
constexpr double kRootAllowance = 1e-9;  // for the rounding of 1e6^(1/3)

/// A product grid of optimal one-dimensional quantisers: cell i has level (i / levels^axis) %
/// levels on an axis.
struct Grid {
  int levels = 1;           // on every axis
  Eigen::MatrixXd points;   // d x M, the cells' means
  Eigen::VectorXd weights;  // M, the cells' probabilities
};

/// The grid with the largest number of levels on every axis that makes at most `most` cells.
Grid make_grid(int dim, double most) {
  const auto levels = static_cast<int>(std::pow(most, 1.0 / dim) + kRootAllowance);
  const NormalQuantiser& quantiser = normal_quantiser(levels);
  Grid grid{.levels = levels, .points = {}, .weights = {}};
  const auto cells = static_cast<Eigen::Index>(std::lround(std::pow(levels, dim)));
  grid.points.resize(dim, cells);
  grid.weights.resize(cells);
  for (Eigen::Index i = 0; i < cells; ++i) {
    double weight = 1.0;
    Eigen::Index rest = i;
    for (int axis = 0; axis < dim; ++axis, rest /= levels) {
      grid.points(axis, i) = quantiser.points[rest % levels];
      weight *= quantiser.weights[rest % levels];
    }
    grid.weights[i] = weight;
  }
  return grid;
}

/// The nearest of the coarse levels for each of the fine ones.
std::vector<int> coarser_levels(int fine, int coarse) {
  const Eigen::VectorXd& points = normal_quantiser(coarse).points;
  std::vector<int> nearest(fine);
  for (int i = 0; i < fine; ++i) {
    (points.array() - normal_quantiser(fine).points[i]).abs().minCoeff(&nearest[i]);
  }
  return nearest;
}

/// Every cell of `fine` takes the cluster of the cell of `coarse` in which its mean lies: an
/// initial guess from which the nearest one is soon found.
std::vector<int> carried_over(const Grid& coarse, const std::vector<int>& clusters,
                              const Grid& fine) {
  const std::vector<int> coarser = coarser_levels(fine.levels, coarse.levels);
  std::vector<int> guess(fine.points.cols());
  for (std::size_t i = 0; i < guess.size(); ++i) {
    std::size_t cell = 0;
    std::size_t stride = 1;
    std::size_t rest = i;
    for (Eigen::Index axis = 0; axis < fine.points.rows(); ++axis, rest /= fine.levels) {
      cell += stride * coarser[rest % fine.levels];
      stride *= coarse.levels;
    }
    guess[i] = clusters[cell];
  }
  return guess;
}

/// Clusters of a grid's cells.
struct Clusters {
  std::vector<int> assignment;
  Eigen::MatrixXd centres;  // d x N
  Eigen::VectorXd masses;   // N
};

/// Makes every centre the mean of its cells. A cluster that lost all of its cells keeps its centre;
/// its mass is zero.
void update(const Grid& grid, Clusters& clusters) {
  Eigen::MatrixXd moments = Eigen::MatrixXd::Zero(grid.points.rows(), clusters.centres.cols());
  clusters.masses.setZero(clusters.centres.cols());
  for (Eigen::Index i = 0; i < grid.points.cols(); ++i) {
    clusters.masses[clusters.assignment[i]] += grid.weights[i];
    moments.col(clusters.assignment[i]) += grid.weights[i] * grid.points.col(i);
  }
  for (Eigen::Index n = 0; n < clusters.masses.size(); ++n) {
    if (clusters.masses[n] > 0.0) clusters.centres.col(n) = moments.col(n) / clusters.masses[n];
  }
}

/// E(x − q)(x − q)ᵀ = I − Cov(q), since q = E[x | q]: the centres are means of means of cells.
Eigen::MatrixXd lost_covariance(const Clusters& clusters) {
  const Eigen::Index dim = clusters.centres.rows();
  return Eigen::MatrixXd::Identity(dim, dim) -
         clusters.centres * clusters.masses.asDiagonal() * clusters.centres.transpose();
}

/// Lloyd's rounds on a grid, until a round gains less than the share `least_gain` of W2².
void descend(const Grid& grid, double least_gain, Clusters& clusters) {
  NearestCentre nearest(grid.points);
  double before = std::numeric_limits<double>::infinity();
  for (int round = 0; round < kLongestDescent; ++round) {
    if (nearest.assign(clusters.centres, clusters.assignment) == 0 && round > 0) return;
    update(grid, clusters);
    const double cost = lost_covariance(clusters).trace();
    if (before - cost < least_gain * cost) return;
    before = cost;
  }
}

/// An orthogonal matrix unrelated to the axes.
Eigen::MatrixXd oblique_basis(Eigen::Index dim) {
  const Eigen::VectorXd steps = Eigen::VectorXd::LinSpaced(dim, 1.0, static_cast<double>(dim));
  const Eigen::MatrixXd waves = (steps * steps.transpose()).array().sin();
  return models::orthogonal_factor(waves);
}

/// The split tree in an oblique basis. Along the axes its cuts would follow those of the grid, and
/// Lloyd's method would start near a saddle point.
Clusters split_tree(const Grid& grid, int count) {
  const Eigen::MatrixXd basis = oblique_basis(grid.points.rows());
  const Compression tree = compress(
      {.locations = basis * grid.points, .weights = grid.weights / grid.weights.sum()}, count,
      /*refinements=*/0);
  return {.assignment = tree.assignment,
          .centres = basis.transpose() * tree.measure.locations,
          .masses = tree.measure.weights};
}

/// The measure of the clusters that have mass, its axes ordered by decreasing lost variance.
NormalLloyd collect(const Clusters& clusters) {
  std::vector<Eigen::Index> kept;
  for (Eigen::Index n = 0; n < clusters.masses.size(); ++n) {
    if (clusters.masses[n] > 0.0) kept.push_back(n);
  }
  const Eigen::MatrixXd lost = lost_covariance(clusters);
  std::vector<Eigen::Index> axes(lost.rows());
  std::iota(axes.begin(), axes.end(), 0);
  std::stable_sort(axes.begin(), axes.end(),
                   [&](auto a, auto b) { return lost(a, a) > lost(b, b); });
  return {.measure = {.locations = clusters.centres(axes, kept), .weights = clusters.masses(kept)},
          .within_covariance = lost(axes, axes)};
}

NormalLloyd make_lloyd(int dim, int count) {
  const Grid coarse =
      make_grid(dim, std::clamp(kCoarseCells * count, kFewestCoarseCells, kMostFineCells));
  Clusters clusters = split_tree(coarse, count);
  descend(coarse, kCoarseGain, clusters);
  const Grid fine =
      make_grid(dim, std::clamp(kFineCells * count, kFewestFineCells, kMostFineCells));
  clusters.assignment = carried_over(coarse, clusters.assignment, fine);
  descend(fine, kFineGain, clusters);
  return collect(clusters);
}

}  // namespace

const NormalLloyd& normal_lloyd(int dim, int count) {
  if (dim < 2 || dim > kLloydDimensions || count < 1 || count > kLloydPoints) {
    throw std::invalid_argument("Lloyd quantiser: too many points or dimensions, or none");
  }
  static std::mutex mutex;
  static std::map<std::pair<int, int>, NormalLloyd> remembered;  // nodes keep their address
  const std::lock_guard lock(mutex);
  const auto found = remembered.find({dim, count});
  if (found != remembered.end()) return found->second;
  return remembered.emplace(std::pair(dim, count), make_lloyd(dim, count)).first->second;
}

}  // namespace qsmpc::controller
