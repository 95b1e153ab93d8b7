#include "controller/certification/unicycle_surrogate.hpp"

#include <algorithm>
#include <cmath>

namespace qsmpc {
namespace {

/// E[r_i r̄_j] of the residuals of two headings, up to the factor e^{iΔ}: with v their variances and
/// c their covariance, e^{−(v_i + v_j − 2c)/2} − e^{−(v_i + v_j)/2}(1 + c). Small covariances are
/// written with expm1, since both terms agree to second order; large ones as they are, since e^c
/// alone would overflow.
double residual_covariance(double variance_i, double variance_j, double covariance) {
  const double sum = 0.5 * (variance_i + variance_j);
  if (covariance > 1.0) return std::exp(covariance - sum) - std::exp(-sum) * (1.0 + covariance);
  return std::exp(-sum) * (std::expm1(covariance) - covariance);
}

}  // namespace

std::vector<GaussianSurrogate> unicycle_surrogates(const UnicycleStructure& unicycle,
                                                   const Gaussian& belief,
                                                   const Eigen::VectorXd& inputs,
                                                   const Eigen::MatrixXd& noise_covariance) {
  std::vector<GaussianSurrogate> surrogates;
  Gaussian law = belief;
  double residual = 0.0;  // E|Σ_j r_j|²
  std::vector<double> headings;
  std::vector<double> variances;
  for (Eigen::Index k = 0; k < inputs.size(); ++k) {
    const double heading =
        belief.mean[unicycle.heading] + unicycle.input_gain * inputs.head(k).sum();
    const double variance =
        belief.covariance(unicycle.heading, unicycle.heading) +
        static_cast<double>(k) * noise_covariance(unicycle.heading, unicycle.heading);
    // Headings are a random walk: the covariance of two is the variance of the earlier.
    for (Eigen::Index j = 0; j < k; ++j) {
      residual += 2.0 * std::cos(heading - headings[j]) *
                  residual_covariance(variance, variances[j], std::min(variance, variances[j]));
    }
    residual += residual_covariance(variance, variance, variance);
    headings.push_back(heading);
    variances.push_back(variance);

    const double shrink = unicycle.reach * std::exp(-0.5 * variance);
    Eigen::MatrixXd transition = Eigen::MatrixXd::Identity(law.mean.size(), law.mean.size());
    transition(unicycle.x, unicycle.heading) = -shrink * std::sin(heading);
    transition(unicycle.y, unicycle.heading) = shrink * std::cos(heading);
    law.mean[unicycle.x] += shrink * std::cos(heading);
    law.mean[unicycle.y] += shrink * std::sin(heading);
    law.mean[unicycle.heading] += unicycle.input_gain * inputs[k];
    law.covariance = transition * law.covariance * transition.transpose() + noise_covariance;
    surrogates.push_back(
        {.law = law, .radius = unicycle.reach * std::sqrt(std::max(0.0, residual))});
  }
  return surrogates;
}

}  // namespace qsmpc
