#include "harness/figures/density.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <stdexcept>
#include <string>

#include <Eigen/LU>

#include "harness/figures/contour_lines.hpp"
#include "models/linear_algebra.hpp"

namespace qsmpc::harness {
namespace {

using Eigen::Index;

constexpr double kTails = 4.0;  // how far a grid extends beyond the points, in standard deviations
                                // of the kernel
// Lower bounds of a standard deviation: relative to the largest one, relative to the mean's
// absolute value, and if both are 0. All are far below what a drawing shows and above rounding.
constexpr double kLeastOfGreatest = 1e-6;
constexpr double kLeastOfMean = 1e-12;
constexpr double kLeastOfZero = 1e-9;

void require(bool condition, const std::string& message) {
  if (!condition) throw std::invalid_argument("kernel density: " + message);
}

/// Weights of `count` points that sum to one.
Eigen::VectorXd normalised(const Eigen::Ref<const Eigen::VectorXd>& weights, Index count) {
  require(count > 0, "there are no points");
  if (weights.size() == 0)
    return Eigen::VectorXd::Constant(count, 1.0 / static_cast<double>(count));
  require(weights.size() == count, "there must be as many weights as points");
  require(weights.allFinite() && weights.minCoeff() >= 0.0, "weights must be finite and ≥ 0");
  const double largest = weights.maxCoeff();
  require(largest > 0.0, "at least one weight must be positive");
  const Eigen::VectorXd scaled = weights / largest;  // no overflow in the sum
  return scaled / scaled.sum();
}

struct PrincipalAxes {
  Eigen::VectorXd mean;
  Eigen::MatrixXd axes;  ///< columns: principal axes times their standard deviations, raised
};

/// `weights` sum to one. The covariance of a single effective point is 0.
PrincipalAxes principal_axes_of(const Eigen::Ref<const Eigen::MatrixXd>& points,
                                const Eigen::VectorXd& weights) {
  const Eigen::VectorXd mean = points * weights;
  const Eigen::MatrixXd centred = points.colwise() - mean;
  const double freedom = 1.0 - weights.squaredNorm();
  Eigen::MatrixXd covariance = centred * weights.asDiagonal() * centred.transpose();
  if (freedom > 0.0) covariance /= freedom;
  const models::SymmetricEigen principal = models::symmetric_eigen(covariance);
  const Eigen::VectorXd deviations = principal.values.cwiseMax(0.0).cwiseSqrt();
  const double least =
      std::max(kLeastOfGreatest * deviations.maxCoeff(), kLeastOfMean * mean.cwiseAbs().maxCoeff());
  const Eigen::VectorXd raised = deviations.cwiseMax(least > 0.0 ? least : kLeastOfZero);
  return {.mean = mean, .axes = principal.vectors * raised.asDiagonal()};
}

/// h = n^(−1/(d + 4)).
double scott_factor(const Eigen::VectorXd& weights, int dim) {
  return std::pow(effective_size(weights), -1.0 / (dim + 4.0));
}

/// N(at_i; sample_j, deviation²), at.size() x sample.size().
Eigen::MatrixXd kernels(const Eigen::Ref<const Eigen::VectorXd>& at,
                        const Eigen::Ref<const Eigen::VectorXd>& sample, double deviation) {
  const double peak = 1.0 / (deviation * std::sqrt(2.0 * std::numbers::pi));
  const Eigen::MatrixXd distance =
      (at.replicate(1, sample.size()).rowwise() - sample.transpose()) / deviation;
  return peak * (-0.5 * distance.array().square()).exp();
}

/// Calls work(first, count) for blocks of 0 … size - 1, so that the kernels of huge samples fit in
/// memory.
template <class Work>
void in_blocks(Index size, const Work& work) {
  constexpr Index kBlock = 4096;
  for (Index first = 0; first < size; first += kBlock) work(first, std::min(kBlock, size - first));
}

Eigen::VectorXd spaced_about(const Eigen::Ref<const Eigen::VectorXd>& sample, double deviation,
                             int count) {
  require(count >= 2, "a grid needs at least two points");
  const double reach = kTails * deviation;
  return Eigen::VectorXd::LinSpaced(count, sample.minCoeff() - reach, sample.maxCoeff() + reach);
}

double kernel_deviation(const Eigen::Ref<const Eigen::VectorXd>& sample,
                        const Eigen::VectorXd& weights) {
  return scott_factor(weights, 1) *
         std::abs(principal_axes_of(sample.transpose(), weights).axes(0, 0));
}

}  // namespace

double effective_size(const Eigen::Ref<const Eigen::VectorXd>& weights) {
  return 1.0 / normalised(weights, weights.size()).squaredNorm();
}

Eigen::VectorXd kernel_density(const Eigen::Ref<const Eigen::VectorXd>& sample,
                               const Eigen::Ref<const Eigen::VectorXd>& weights,
                               const Eigen::Ref<const Eigen::VectorXd>& at) {
  require(sample.allFinite() && at.allFinite(), "points must be finite");
  const Eigen::VectorXd w = normalised(weights, sample.size());
  const double deviation = kernel_deviation(sample, w);
  Eigen::VectorXd density = Eigen::VectorXd::Zero(at.size());
  in_blocks(sample.size(), [&](Index first, Index count) {
    density += kernels(at, sample.segment(first, count), deviation) * w.segment(first, count);
  });
  return density;
}

DensityCurve density_curve(const Eigen::Ref<const Eigen::VectorXd>& sample,
                           const Eigen::Ref<const Eigen::VectorXd>& weights, int count) {
  require(sample.allFinite(), "points must be finite");
  const Eigen::VectorXd w = normalised(weights, sample.size());
  const Eigen::VectorXd x = spaced_about(sample, kernel_deviation(sample, w), count);
  const Eigen::VectorXd density = kernel_density(sample, w, x);
  return {.x = {x.begin(), x.end()}, .density = {density.begin(), density.end()}};
}

double DensityGrid::cell_area() const {
  return std::abs(basis.determinant()) * (u[1] - u[0]) * (v[1] - v[0]);
}

DensityGrid density_grid(const Eigen::Ref<const Eigen::Matrix2Xd>& points,
                         const Eigen::Ref<const Eigen::VectorXd>& weights, int count) {
  require(points.allFinite(), "points must be finite");
  const Eigen::VectorXd w = normalised(weights, points.cols());
  const PrincipalAxes spread = principal_axes_of(points, w);
  DensityGrid grid{.centre = spread.mean, .basis = spread.axes};
  // In units of the principal axes the kernel's covariance is h² I: a product of one kernel per
  // axis.
  const double deviation = scott_factor(w, 2);
  const Eigen::Matrix2Xd own = grid.basis.inverse() * (points.colwise() - grid.centre);
  grid.u = spaced_about(own.row(0).transpose(), deviation, count);
  grid.v = spaced_about(own.row(1).transpose(), deviation, count);
  grid.density = Eigen::MatrixXd::Zero(count, count);
  in_blocks(points.cols(), [&](Index first, Index size) {
    const Eigen::MatrixXd along = own.middleCols(first, size);
    grid.density += kernels(grid.u, along.row(0).transpose(), deviation) *
                    w.segment(first, size).asDiagonal() *
                    kernels(grid.v, along.row(1).transpose(), deviation).transpose();
  });
  grid.density /= std::abs(grid.basis.determinant());
  return grid;
}

double highest_density_level(const DensityGrid& grid, double mass) {
  require(mass > 0.0 && mass < 1.0, "a region's mass must lie between 0 and 1");
  std::vector<double> values(grid.density.data(), grid.density.data() + grid.density.size());
  std::sort(values.begin(), values.end(), std::greater<>());
  const double wanted = mass * grid.density.sum();
  double held = 0.0;
  for (const double value : values) {
    held += value;
    if (held >= wanted) return value;
  }
  return values.back();
}

std::vector<DensityContour> density_contours(const DensityGrid& grid,
                                             const std::vector<double>& masses) {
  std::vector<DensityContour> contours;
  for (const double mass : masses) {
    const double level = highest_density_level(grid, mass);
    for (const Eigen::Matrix2Xd& line : contour_lines(grid.density, level)) {
      const Eigen::Vector2d step(grid.u[1] - grid.u[0], grid.v[1] - grid.v[0]);
      const Eigen::Matrix2Xd own =
          (step.asDiagonal() * line).colwise() + Eigen::Vector2d(grid.u[0], grid.v[0]);
      contours.push_back({.mass = mass, .points = (grid.basis * own).colwise() + grid.centre});
    }
  }
  return contours;
}

}  // namespace qsmpc::harness
