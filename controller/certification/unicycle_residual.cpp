#include "controller/certification/unicycle_residual.hpp"

#include <cmath>
#include <complex>

namespace qsmpc {
namespace {

// Below this exponent five terms of the series are exact to rounding, and e^c − 1 − c is not.
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

UnicycleResidual::UnicycleResidual(const UnicycleStructure& unicycle, Eigen::Index dim)
    : unicycle_(unicycle), second_moment_(Eigen::MatrixXd::Zero(dim, dim)) {}

void UnicycleResidual::add_stage(const Gaussian& law, const Eigen::MatrixXd& transition) {
  const int heading = unicycle_.heading;
  const double mean = law.mean[heading];
  const double variance = law.covariance(heading, heading);
  const Eigen::Index dim = transition.rows();
  Eigen::MatrixXd cross = Eigen::MatrixXd::Zero(dim, 2);  // E[A κ ρ_kᵀ]
  for (Past& past : past_) {
    past.carried = transition * past.carried;
    cross += past.carried *
             residual_moments(past.mean, past.variance, mean, variance, past.covariance[heading]);
    past.covariance = transition * past.covariance;
  }
  Eigen::MatrixXd entry = Eigen::MatrixXd::Zero(dim, 2);  // where ρ_k enters the state
  entry(unicycle_.x, 0) = unicycle_.reach;
  entry(unicycle_.y, 1) = unicycle_.reach;
  const Eigen::MatrixXd mixed = cross * entry.transpose();
  second_moment_ =
      transition * second_moment_ * transition.transpose() + mixed + mixed.transpose() +
      entry * residual_moments(mean, variance, mean, variance, variance) * entry.transpose();
  past_.push_back({.mean = mean,
                   .variance = variance,
                   .covariance = transition * law.covariance.col(heading),
                   .carried = entry});
}

Eigen::VectorXd UnicycleResidual::root_mean_squares() const {
  return second_moment_.diagonal().cwiseMax(0.0).cwiseSqrt();
}

}  // namespace qsmpc
