#include "controller/measure/compression/soft_compression.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "controller/measure/compression/compression.hpp"

namespace qsmpc::controller {
namespace {

void check_settings(const SoftCompressionSettings& settings) {
  if (settings.count < 1) {
    throw std::invalid_argument("soft compression: at least one point must be kept");
  }
  if (!std::isfinite(settings.sharpness) || settings.sharpness <= 0.0) {
    throw std::invalid_argument("soft compression: the sharpness must be positive and finite");
  }
  if (settings.rounds < 1) {
    throw std::invalid_argument("soft compression: at least one round is needed");
  }
  if (!std::isfinite(settings.tolerance) || settings.tolerance < 0.0) {
    throw std::invalid_argument("soft compression: the tolerance must be finite and not negative");
  }
}

/// |c_i − c̃_n|² for all pairs (n x N).
Eigen::MatrixXd squared_distances(const Points& points, const Points& centres) {
  Eigen::MatrixXd squares(points.cols(), centres.cols());
  for (Eigen::Index n = 0; n < centres.cols(); ++n) {
    squares.col(n) = (points.colwise() - centres.col(n)).colwise().squaredNorm().transpose();
  }
  return squares;
}

/// w_in: the nearest centre's exponent is subtracted, so that none overflows.
Eigen::MatrixXd soft_assignments(const Points& points, const Points& centres, double sharpness) {
  const Eigen::MatrixXd distances = squared_distances(points, centres).cwiseSqrt();
  const Eigen::VectorXd nearest = distances.rowwise().minCoeff();
  Eigen::MatrixXd shares =
      (sharpness * (nearest.rowwise().replicate(centres.cols()) - distances)).array().exp();
  return shares.array().colwise() / shares.rowwise().sum().array();
}

/// Masses and means of the clusters; a cluster without mass keeps its centre.
void update_clusters(const DiscreteMeasure& measure, SoftCompression& result) {
  const Eigen::MatrixXd masses = measure.weights.asDiagonal() * result.responsibilities;
  const Points moments = measure.locations * masses;
  result.measure.weights = masses.colwise().sum().transpose();
  for (Eigen::Index n = 0; n < moments.cols(); ++n) {
    if (result.measure.weights[n] > 0.0) {
      result.measure.locations.col(n) = moments.col(n) / result.measure.weights[n];
    }
  }
}

/// Σ ρ_i w_in (c_i − c̃_n)(c_i − c̃_n)ᵀ, cluster by cluster.
Eigen::MatrixXd lost_covariance(const DiscreteMeasure& measure, const SoftCompression& result) {
  Eigen::MatrixXd lost = Eigen::MatrixXd::Zero(measure.dim(), measure.dim());
  for (Eigen::Index n = 0; n < result.measure.size(); ++n) {
    const Points offsets = measure.locations.colwise() - result.measure.locations.col(n);
    const Eigen::VectorXd masses = measure.weights.cwiseProduct(result.responsibilities.col(n));
    lost += offsets * masses.asDiagonal() * offsets.transpose();
  }
  return lost;
}

}  // namespace

SoftCompression compress_soft(const DiscreteMeasure& measure,
                              const SoftCompressionSettings& settings) {
  check_settings(settings);
  SoftCompression result;
  result.measure = compress(measure, settings.count, /*refinements=*/0).measure;
  const double spread = std::sqrt(covariance_of(measure).trace());
  for (int round = 0; round < settings.rounds && !result.converged; ++round) {
    const Points before = result.measure.locations;
    result.responsibilities = soft_assignments(measure.locations, before, settings.sharpness);
    update_clusters(measure, result);
    const double moved = (result.measure.locations - before).colwise().norm().maxCoeff();
    result.converged = moved <= settings.tolerance * spread;
  }
  result.within_covariance = lost_covariance(measure, result);
  result.w2 = std::sqrt(result.within_covariance.trace());
  return result;
}

}  // namespace qsmpc::controller
