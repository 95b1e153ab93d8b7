#include "controller/certification/path_tilt.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/LU>

#include "controller/measure/normal/normal_distribution.hpp"

namespace qsmpc::controller {
namespace {

// The share of a functional's variance that must be left once it is uncorrelated with the others.
constexpr double kLeastFreeShare = 1e-6;
// The grid's spacing, in deviations of the density that smooths its sum: δ is about
// 2e^{−2π²/1.8²} = 0.45 %.
constexpr double kSpacing = 1.8;
// Grid points beyond this many deviations of their law are omitted; their weight counts in full.
constexpr double kFarthest = 4.9;

/// Bounds |1 − Σ_i h N(x; ih, τ²)| for every x, where h = spacing · τ.
double grid_ripple(double spacing) {
  const double decay = std::exp(-2.0 * std::numbers::pi * std::numbers::pi / (spacing * spacing));
  return 2.0 * decay / (1.0 - decay);
}

const Eigen::MatrixXd& covariance_of(const PredictedMotion& motion, std::size_t block) {
  return block == 0 ? motion.belief.covariance : motion.noise_covariance;
}

}  // namespace

bool add_functional(const PredictedMotion& motion, const std::vector<Eigen::VectorXd>& weights,
                    PathFunctionals& functionals) {
  std::vector<Eigen::VectorXd> left = weights;
  double whole = 0.0;
  for (std::size_t j = 0; j < left.size(); ++j) {
    whole += left[j].dot(covariance_of(motion, j) * left[j]);
  }
  for (Eigen::Index r = 0; r < functionals.count(); ++r) {
    double covariance = 0.0;
    for (std::size_t j = 0; j < left.size(); ++j) {
      covariance += left[j].dot(functionals.moves[j].col(r));
    }
    for (std::size_t j = 0; j < left.size(); ++j) {
      left[j] -= covariance * functionals.weights[j].col(r);
    }
  }
  double variance = 0.0;
  for (std::size_t j = 0; j < left.size(); ++j) {
    variance += left[j].dot(covariance_of(motion, j) * left[j]);
  }
  if (!(variance > kLeastFreeShare * whole) || !std::isfinite(variance)) return false;
  const Eigen::Index count = functionals.count();
  functionals.weights.resize(left.size());
  functionals.moves.resize(left.size());
  for (std::size_t j = 0; j < left.size(); ++j) {
    left[j] /= std::sqrt(variance);
    functionals.weights[j].conservativeResize(left[j].size(), count + 1);
    functionals.weights[j].col(count) = left[j];
    functionals.moves[j].conservativeResize(left[j].size(), count + 1);
    functionals.moves[j].col(count) = covariance_of(motion, j) * left[j];
  }
  return true;
}

Eigen::MatrixXd independent_part(const Eigen::MatrixXd& covariance, const PathTilt& tilt,
                                 Eigen::Index block) {
  if (tilt.empty()) return covariance;
  const Eigen::MatrixXd& weights = tilt.functionals.weights[static_cast<std::size_t>(block)];
  if (weights.isZero(0.0)) return covariance;
  const Eigen::MatrixXd& moves = tilt.functionals.moves[static_cast<std::size_t>(block)];
  // The tilt adds (1/w² − 1) Λ Λᵀ to the joint precision of all blocks; the covariance of one block
  // given the others is the inverse of its diagonal block (Woodbury).
  const Eigen::ArrayXd squares = tilt.spreads.array().square();
  Eigen::MatrixXd inner = weights.transpose() * moves;
  inner.diagonal() += (squares / (1.0 - squares)).matrix();
  Eigen::MatrixXd part = covariance - moves * inner.partialPivLu().solve(moves.transpose());
  part.diagonal() = part.diagonal().cwiseMax(0.0);
  return 0.5 * (part + part.transpose());
}

bool concerns_only(const PathTilt& tilt, Eigen::Index block, Eigen::Index axis) {
  if (tilt.empty()) return true;
  const Eigen::MatrixXd& weights = tilt.functionals.weights[static_cast<std::size_t>(block)];
  for (Eigen::Index i = 0; i < weights.rows(); ++i) {
    if (i != axis && !weights.row(i).isZero(0.0)) return false;
  }
  return true;
}

TiltGrid tilt_grid(double spread) {
  // Σ h N(c; 0, 1 − w²) N(a; c, w²) over c = ih is N(a; 0, 1) times the sum of a normal density of
  // deviation τ = w √(1 − w²) over a grid, which is nearly 1.
  const double across = std::sqrt(1.0 - spread * spread);
  const double step = kSpacing * spread * across;
  const double factor = 1.0 / (1.0 - grid_ripple(kSpacing));
  const auto half = static_cast<Eigen::Index>(kFarthest * across / step);
  TiltGrid grid{
      .places = step * Eigen::VectorXd::LinSpaced(2 * half + 1, -static_cast<double>(half),
                                                  static_cast<double>(half)),
      .weights = Eigen::VectorXd(2 * half + 1)};
  for (Eigen::Index i = 0; i < grid.places.size(); ++i) {
    grid.weights[i] = factor * step / across * normal_density(grid.places[i] / across);
  }
  // All weights together are a sum of a normal density over a grid, too.
  const double all = factor * (1.0 + grid_ripple(step / across));
  grid.left_out = std::max(0.0, all - grid.weights.sum());
  return grid;
}

}  // namespace qsmpc::controller
