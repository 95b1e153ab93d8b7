#include "controller/measure/wasserstein.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <stdexcept>
#include <vector>

#include <Eigen/SVD>
#include <lemon/network_simplex.h>
#include <lemon/smart_graph.h>

#include "models/linear_algebra.hpp"

namespace qsmpc::controller {
namespace {

using Graph = lemon::SmartDigraph;
using Simplex = lemon::NetworkSimplex<Graph, std::int64_t, std::int64_t>;

constexpr std::int64_t kWholeMass = std::int64_t{1} << 60;
// The simplex starts from artificial arcs of cost 2^62. A node's potential differs from it, or from
// zero, by the costs along a path, which must stay well below that for sums to fit in 64 bits.
constexpr double kPathCost = 0x1p61;

/// The points of a measure that have weight, with integer masses that sum to kWholeMass.
struct Supply {
  Points locations;
  std::vector<std::int64_t> masses;
};

Supply make_supply(const DiscreteMeasure& measure) {
  const double sum = measure.weights.sum();
  std::vector<Eigen::Index> kept;
  Supply supply;
  for (Eigen::Index i = 0; i < measure.size(); ++i) {
    const auto mass =
        static_cast<std::int64_t>(std::llround(measure.weights[i] / sum * kWholeMass));
    if (mass == 0) continue;
    kept.push_back(i);
    supply.masses.push_back(mass);
  }
  // The rounding remainder (about 1e-16 of the total) goes to the heaviest point.
  *std::max_element(supply.masses.begin(), supply.masses.end()) +=
      kWholeMass - std::accumulate(supply.masses.begin(), supply.masses.end(), std::int64_t{0});
  supply.locations = measure.locations(Eigen::all, kept);
  return supply;
}

/// Squared distances of all pairs, one point of `from` after the other.
std::vector<double> pairwise_squared_distances(const Points& from, const Points& to) {
  std::vector<double> distances(from.cols() * to.cols());
  for (Eigen::Index i = 0; i < from.cols(); ++i) {
    Eigen::Map<Eigen::RowVectorXd>(&distances[i * to.cols()], to.cols()) =
        (to.colwise() - from.col(i)).colwise().squaredNorm();
  }
  return distances;
}

/// The costs of arcs, which are numbered in the order of `distances`, in fixed point.
struct FixedPointCosts {
  const std::vector<double>& distances;
  double scale;
  std::int64_t operator[](const Graph::Arc& arc) const {
    return std::llround(scale * distances[Graph::id(arc)]);
  }
};

/// Σ mass · distance of an optimal plan between `from` and `to`, for a total mass of one.
double transport_cost(const Supply& from, const Supply& to) {
  const auto rows = static_cast<int>(from.masses.size());
  const auto columns = static_cast<int>(to.masses.size());
  const std::vector<double> distances = pairwise_squared_distances(from.locations, to.locations);
  const double largest = *std::max_element(distances.begin(), distances.end());
  if (largest == 0.0) return 0.0;

  Graph graph;
  graph.reserveNode(rows + columns);
  graph.reserveArc(rows * columns);
  Graph::NodeMap<std::int64_t> masses(graph);
  for (const std::int64_t mass : from.masses) masses[graph.addNode()] = mass;
  for (const std::int64_t mass : to.masses) masses[graph.addNode()] = -mass;
  for (int i = 0; i < rows; ++i) {
    for (int j = 0; j < columns; ++j) {
      graph.addArc(Graph::nodeFromId(i), Graph::nodeFromId(rows + j));
    }
  }
  // A path alternates between the two sides, so it has at most this many arcs.
  const double path = 2.0 * std::min(rows, columns) + 2.0;
  Simplex simplex(graph);
  simplex.supplyMap(masses).costMap(
      FixedPointCosts{.distances = distances, .scale = kPathCost / path / largest});
  if (simplex.run() != Simplex::OPTIMAL) {
    throw std::logic_error("Wasserstein distance: the transport problem was not solved");
  }
  double cost = 0.0;
  for (int arc = 0; arc < rows * columns; ++arc) {
    const std::int64_t mass = simplex.flow(Graph::arcFromId(arc));
    if (mass > 0) cost += static_cast<double>(mass) * distances[arc];
  }
  return cost / kWholeMass;
}

/// A matrix R with R Rᵀ = covariance.
Eigen::MatrixXd root(const Eigen::MatrixXd& covariance) {
  const models::SymmetricEigen eigen = models::symmetric_eigen(covariance);
  return eigen.vectors * eigen.values.cwiseMax(0.0).cwiseSqrt().asDiagonal();
}

}  // namespace

double wasserstein2(const DiscreteMeasure& first, const DiscreteMeasure& second) {
  check_measure(first);
  check_measure(second);
  if (first.dim() != second.dim()) {
    throw std::invalid_argument("Wasserstein distance: the measures' dimensions differ");
  }
  const Supply from = make_supply(first);
  const Supply to = make_supply(second);
  if (from.locations.cols() > kTransportPairs / to.locations.cols()) {
    throw std::length_error("Wasserstein distance: too many pairs of points");
  }
  return std::sqrt(transport_cost(from, to));
}

double wasserstein2(const Gaussian& first, const Gaussian& second) {
  check_gaussian(first);
  check_gaussian(second);
  if (first.mean.size() != second.mean.size()) {
    throw std::invalid_argument("Wasserstein distance: the Gaussians' dimensions differ");
  }
  const Eigen::MatrixXd from = root(first.covariance);
  const Eigen::MatrixXd to = root(second.covariance);
  // |R₁ − R₂ Q|² is least where tr(R₁ᵀ R₂ Q) is largest: for R₂ᵀ R₁ = U S Vᵀ at Q = U Vᵀ.
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(to.transpose() * from,
                                              Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Eigen::MatrixXd aligned = to * svd.matrixU() * svd.matrixV().transpose();
  return std::hypot((first.mean - second.mean).norm(), (from - aligned).norm());
}

}  // namespace qsmpc::controller
