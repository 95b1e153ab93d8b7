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

/// The grid points of one functional. Σ h N(c; 0, 1 − w²) N(a; c, w²) over c = ih is N(a; 0, 1)
/// times the sum of a normal density of deviation τ = w √(1 − w²) over a grid, which is nearly 1.
class GridAxis {
 public:
  explicit GridAxis(double spread)
      : across_(std::sqrt(1.0 - spread * spread)), step_(kSpacing * spread * across_) {}

  /// Grid points −half … half are within reach.
  [[nodiscard]] int half() const { return static_cast<int>(kFarthest * across_ / step_); }
  [[nodiscard]] double place(int i) const { return i * step_; }
  /// The grid point in deviations of the grid points' law.
  [[nodiscard]] double deviations(int i) const { return place(i) / across_; }
  [[nodiscard]] double weight(int i) const {
    return step_ / across_ * normal_density(deviations(i));
  }
  /// Bounds the sum of the weights of all grid points, including those out of reach: it is itself a
  /// sum of a normal density over a grid.
  [[nodiscard]] double most_weight() const { return 1.0 + grid_ripple(step_ / across_); }

 private:
  double across_;  ///< deviation of the grid points' law
  double step_;    ///< h
};

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

TiltGrid tilt_grid(const Eigen::VectorXd& spreads) {
  TiltGrid grid;
  std::vector<GridAxis> axes;
  double all = 1.0;
  for (const double spread : spreads) {
    axes.emplace_back(spread);
    grid.factor /= 1.0 - grid_ripple(kSpacing);
    all *= axes.back().most_weight();
  }
  std::vector<Eigen::VectorXd> centres;
  std::vector<double> weights;
  std::vector<int> at(axes.size());
  for (std::size_t r = 0; r < axes.size(); ++r) at[r] = -axes[r].half();
  double listed = 0.0;
  while (true) {
    Eigen::VectorXd centre(spreads.size());
    double weight = 1.0;
    double square = 0.0;  // in deviations of the grid points' law
    for (std::size_t r = 0; r < axes.size(); ++r) {
      centre[static_cast<Eigen::Index>(r)] = axes[r].place(at[r]);
      weight *= axes[r].weight(at[r]);
      square += axes[r].deviations(at[r]) * axes[r].deviations(at[r]);
    }
    if (square <= kFarthest * kFarthest) {
      centres.push_back(centre);
      weights.push_back(weight);
      listed += weight;
    }
    std::size_t next = 0;
    while (next < at.size() && ++at[next] > axes[next].half()) {
      at[next] = -axes[next].half();
      ++next;
    }
    if (next == at.size()) break;
  }
  const auto count = static_cast<Eigen::Index>(centres.size());
  grid.centres.resize(spreads.size(), count);
  grid.weights = Eigen::Map<const Eigen::VectorXd>(weights.data(), count);
  for (Eigen::Index i = 0; i < count; ++i) {
    grid.centres.col(i) = centres[static_cast<std::size_t>(i)];
  }
  grid.left_out = std::max(0.0, all - listed);
  return grid;
}

}  // namespace qsmpc::controller
