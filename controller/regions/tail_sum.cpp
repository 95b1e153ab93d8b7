#include "controller/regions/tail_sum.hpp"

#include <cmath>

#include "controller/measure/normal/normal_distribution.hpp"

namespace qsmpc::controller {
namespace {

// −d log Φ(−z)/dz at 0: √(2/π).
constexpr double kSlopeAtEdge = 0.79788456080286536;

double tail_slope(double z) {
  return z >= 0.0 ? -normal_density(z) : -kSlopeAtEdge * extended_tail(z);
}

}  // namespace

double extended_tail(double z) {
  return z >= 0.0 ? normal_cumulative(-z) : 0.5 * std::exp(-kSlopeAtEdge * z);
}

void TailSum::clear(Eigen::Index dim) {
  value_ = 0.0;
  by_mean_.setZero(dim);
  by_covariance_.setZero(dim, dim);
}

void TailSum::add(double z, std::span<const Eigen::Index> axes, std::span<const double> slope,
                  double weight) {
  value_ += weight * extended_tail(z);
  const double by_z = weight * tail_slope(z);
  for (std::size_t i = 0; i < axes.size(); ++i) {
    by_mean_[axes[i]] += by_z * slope[i];
    for (std::size_t j = 0; j < axes.size(); ++j) {
      by_covariance_(axes[i], axes[j]) -= 0.5 * z * by_z * slope[i] * slope[j];
    }
  }
}

}  // namespace qsmpc::controller
