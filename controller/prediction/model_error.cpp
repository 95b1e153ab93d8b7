#include "controller/prediction/model_error.hpp"

#include <cmath>
#include <iterator>
#include <limits>
#include <stdexcept>
#include <utility>

namespace qsmpc::controller {
namespace {

/// (mean |value|^order)^{1/order} row by row, scaled so that no power over- or underflows.
Eigen::VectorXd sample_norms(const Eigen::Ref<const Eigen::MatrixXd>& values, int order) {
  const Eigen::VectorXd scale = values.cwiseAbs().rowwise().maxCoeff();
  Eigen::VectorXd norms = Eigen::VectorXd::Zero(values.rows());
  for (Eigen::Index i = 0; i < values.rows(); ++i) {
    if (scale[i] == 0.0) continue;
    const double mean = (values.row(i) / scale[i]).array().abs().pow(order).mean();
    norms[i] = scale[i] * std::pow(mean, 1.0 / order);
  }
  return norms;
}

}  // namespace

const ModelError& ModelError::of_period(Eigen::Index period) const {
  return period < std::ssize(first) ? first[static_cast<std::size_t>(period)] : *this;
}

double ModelError::radius() const {
  if (stated_radius) return *stated_radius;
  if (offset.size() == 0) return root_mean_square.norm();
  return (offset.cwiseAbs() + root_mean_square).norm();
}

ModelError model_error_of_size(const Eigen::VectorXd& root_mean_square) {
  return {
      .mean = {},
      .covariance = {},
      .root_mean_square = root_mean_square,
      .higher = constant_norms(root_mean_square.size(), std::numeric_limits<double>::infinity())};
}

ModelError model_error_of(const Eigen::Ref<const Eigen::MatrixXd>& residuals) {
  if (residuals.cols() == 0) throw std::invalid_argument("model error: no samples");
  const Eigen::VectorXd mean = residuals.rowwise().mean();
  const Eigen::MatrixXd centred = residuals.colwise() - mean;
  ModelError error{
      .mean = mean,
      .covariance = centred * centred.transpose() / static_cast<double>(residuals.cols()),
      .root_mean_square = sample_norms(residuals, 2),
      .higher = {}};
  for (std::size_t k = 0; k < kHigherOrders.size(); ++k) {
    error.higher[k] = sample_norms(residuals, kHigherOrders[k]);
  }
  return error;
}

ModelError widened(ModelError error, double factor) {
  error.root_mean_square *= factor;
  for (Eigen::VectorXd& norms : error.higher) norms *= factor;
  if (error.stated_radius) *error.stated_radius *= factor;
  for (ModelError& own : error.first) own = widened(std::move(own), factor);
  return error;
}

}  // namespace qsmpc::controller
