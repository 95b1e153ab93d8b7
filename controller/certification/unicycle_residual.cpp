#include "controller/certification/unicycle_residual.hpp"

#include <algorithm>
#include <cmath>
#include <complex>

#include "controller/certification/higher_order_norms.hpp"

namespace qsmpc::controller {
namespace {

// Below this exponent five terms of the series are exact to rounding, whereas e^c − 1 − c cancels.
constexpr double kSmallExponent = 1e-3;

/// e^{−s}(e^{c} − 1 − c), also where e^c alone would overflow and where both parts nearly cancel.
double exponential_rest(double exponent, double sum) {
  if (exponent > 1.0) return std::exp(exponent - sum) - std::exp(-sum) * (1.0 + exponent);
  if (std::abs(exponent) > kSmallExponent) {
    return std::exp(-sum) * (std::expm1(exponent) - exponent);
  }
  const double series =
      1.0 +
      exponent / 3.0 * (1.0 + exponent / 4.0 * (1.0 + exponent / 5.0 * (1.0 + exponent / 6.0)));
  return std::exp(-sum) * 0.5 * exponent * exponent * series;
}

}  // namespace

// With s = (v_i + v_j)/2:
//     E[r_i r̄_j] = e^{i(m_i − m_j)} e^{−s} (e^{c} − 1 − c),
//     E[r_i r_j] = e^{i(m_i + m_j)} e^{−s} (e^{−c} − 1 + c).
Eigen::Matrix2d residual_moments(double mean_i, double variance_i, double mean_j, double variance_j,
                                 double covariance) {
  const double sum = 0.5 * (variance_i + variance_j);
  const std::complex<double> conjugate =
      std::polar(1.0, mean_i - mean_j) * exponential_rest(covariance, sum);
  const std::complex<double> plain =
      std::polar(1.0, mean_i + mean_j) * exponential_rest(-covariance, sum);
  Eigen::Matrix2d moments;
  moments << conjugate.real() + plain.real(), plain.imag() - conjugate.imag(),
      plain.imag() + conjugate.imag(), conjugate.real() - plain.real();
  return 0.5 * moments;
}

// From Taylor's formula,
//     cos δ − e^{−v/2} = −(δ² − v)/2 + a,      |a| ≤ δ⁴/24 + v²/8,
//     sin δ − e^{−v/2}δ = −(δ³ − 3vδ)/6 + b,  |b| ≤ |δ|⁵/120 + |δ| v²/8.
HeadingNorms heading_norms(double variance, std::size_t k) {
  const HigherOrderNorms& norms = higher_order_norms(k);
  const double deviation = std::sqrt(variance);
  const double square = variance * variance;
  return {.along =
              std::min(2.0, 0.5 * variance * norms.square + square * (norms.fourth / 24.0 + 0.125)),
          .across = std::min(1.0 + deviation * norms.first,
                             deviation * variance * norms.cube / 6.0 +
                                 deviation * square * (norms.fifth / 120.0 + 0.125 * norms.first))};
}

UnicycleResidual::UnicycleResidual(const models::UnicycleStructure& unicycle, Eigen::Index dim,
                                   Eigen::Index stages)
    : unicycle_(unicycle),
      past_(dim, 3 * stages),
      shifted_(dim, 3 * stages),
      second_moment_(Eigen::MatrixXd::Zero(dim, dim)) {}

void UnicycleResidual::add_stage(const Gaussian& law, const Eigen::MatrixXd& transition,
                                 const TiltedCovariance* tilted) {
  const int heading = unicycle_.heading;
  const double mean = law.mean[heading];
  const double variance = law.covariance(heading, heading);
  const auto before = static_cast<Eigen::Index>(means_.size());
  Eigen::Matrix<double, Eigen::Dynamic, 2> cross =
      Eigen::MatrixXd::Zero(transition.rows(), 2);  // E[A κ ρ_kᵀ]
  const bool is_tilted = tilted != nullptr && tilted->is_tilted();
  const Eigen::VectorXd tilt = is_tilted ? tilted->with_functionals(heading) : Eigen::VectorXd();
  shifted_.leftCols(3 * before) = transition.lazyProduct(past_.leftCols(3 * before));
  for (Eigen::Index j = 0; j < before; ++j) {
    double covariance = past_(heading, 3 * j);
    if (is_tilted) covariance -= tilt.dot(tilts_[static_cast<std::size_t>(j)]);
    cross += shifted_.middleCols<2>(3 * j + 1).lazyProduct(
        residual_moments(means_[j], variances_[j], mean, variance, covariance));
  }
  past_.swap(shifted_);
  Eigen::Matrix<double, Eigen::Dynamic, 2> entry =
      Eigen::MatrixXd::Zero(transition.rows(), 2);  // where ρ_k enters the state
  entry(unicycle_.x, 0) = unicycle_.reach;
  entry(unicycle_.y, 1) = unicycle_.reach;
  const Eigen::MatrixXd mixed = cross.lazyProduct(entry.transpose());
  const Eigen::Matrix2d own = residual_moments(mean, variance, mean, variance, variance);
  second_moment_ = transition * second_moment_ * transition.transpose() + mixed +
                   mixed.transpose() + entry * own * entry.transpose();
  means_.push_back(mean);
  variances_.push_back(variance);
  tilts_.push_back(tilt);
  past_.col(3 * before) =
      transition * (is_tilted ? tilted->covariance() : law.covariance).col(heading);
  past_.middleCols<2>(3 * before + 1) = entry;
}

Eigen::VectorXd UnicycleResidual::root_mean_squares() const {
  return second_moment_.diagonal().cwiseMax(0.0).cwiseSqrt();
}

}  // namespace qsmpc::controller
