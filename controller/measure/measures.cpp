#include "controller/measure/measures.hpp"

#include <cmath>
#include <stdexcept>

#include "models/linear_algebra.hpp"

namespace qsmpc::controller {
namespace {

constexpr double kRoundingAllowance = 1e-9;  // relative; for numbers that come from files

}  // namespace

void check_gaussian(const Gaussian& gaussian) {
  const Eigen::Index dim = gaussian.mean.size();
  if (dim == 0) throw std::invalid_argument("Gaussian: no coordinates");
  if (gaussian.covariance.rows() != dim || gaussian.covariance.cols() != dim) {
    throw std::invalid_argument("Gaussian: the covariance must be square, of the mean's size");
  }
  if (!gaussian.mean.allFinite() || !gaussian.covariance.allFinite()) {
    throw std::invalid_argument("Gaussian: mean and covariance must be finite");
  }
  const double allowance = kRoundingAllowance * gaussian.covariance.cwiseAbs().maxCoeff();
  const Eigen::MatrixXd asymmetry = gaussian.covariance - gaussian.covariance.transpose();
  if (asymmetry.cwiseAbs().maxCoeff() > allowance) {
    throw std::invalid_argument("Gaussian: the covariance is not symmetric");
  }
  if (models::symmetric_eigenvalues(gaussian.covariance).minCoeff() < -allowance) {
    throw std::invalid_argument("Gaussian: the covariance is not positive semidefinite");
  }
}

void check_measure(const DiscreteMeasure& measure) {
  if (measure.size() == 0 || measure.dim() == 0) {
    throw std::invalid_argument("discrete measure: no points");
  }
  if (measure.weights.size() != measure.size()) {
    throw std::invalid_argument(
        "discrete measure: the numbers of weights and points must be equal");
  }
  if (!measure.locations.allFinite() || !measure.weights.allFinite()) {
    throw std::invalid_argument("discrete measure: locations and weights must be finite");
  }
  if (measure.weights.minCoeff() < 0.0) {
    throw std::invalid_argument("discrete measure: negative weight");
  }
  if (std::abs(measure.weights.sum() - 1.0) > kRoundingAllowance) {
    throw std::invalid_argument("discrete measure: the weights do not sum to one");
  }
}

Eigen::VectorXd mean_of(const DiscreteMeasure& measure) {
  return measure.locations * measure.weights;
}

Eigen::MatrixXd covariance_of(const DiscreteMeasure& measure) {
  const Points centred = measure.locations.colwise() - mean_of(measure);
  return centred * measure.weights.asDiagonal() * centred.transpose();
}

}  // namespace qsmpc::controller
