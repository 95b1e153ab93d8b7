#include "controller/planning/solvers/input_bounding.hpp"

#include <algorithm>
#include <cmath>

namespace qsmpc::controller {
namespace {

// A start nearer to a bound than this fraction of the range is moved inwards: on the flat ends of
// the sigmoid the gradient vanishes and the solver could not leave the bound again. With only one
// finite bound, the unit length of the softplus takes the place of the range.
constexpr double kStartMargin = 0.02;

double sigma(double theta) { return 1.0 / (1.0 + std::exp(-theta)); }

/// ln(1 + e^θ), without overflow.
double softplus(double theta) {
  return std::max(theta, 0.0) + std::log1p(std::exp(-std::abs(theta)));
}

/// softplus⁻¹, for positive arguments.
double softplus_inverse(double value) { return value + std::log(-std::expm1(-value)); }

double share_of(InputBounding bounding, double theta) {
  return bounding == InputBounding::kTanh ? 0.5 * (1.0 + std::tanh(theta)) : sigma(theta);
}

double to_input(InputBounding bounding, double theta, double lower, double upper) {
  const bool below = std::isfinite(lower);
  const bool above = std::isfinite(upper);
  if (below && above) {
    // Rounding may carry lower + (upper − lower) beyond upper.
    return std::min(lower + (upper - lower) * share_of(bounding, theta), upper);
  }
  if (below) return lower + softplus(theta);
  return above ? upper - softplus(-theta) : theta;
}

double to_theta(InputBounding bounding, double z, double lower, double upper) {
  const bool below = std::isfinite(lower);
  const bool above = std::isfinite(upper);
  if (below && above) {
    if (lower == upper) return 0.0;
    const double share =
        std::clamp((z - lower) / (upper - lower), kStartMargin, 1.0 - kStartMargin);
    const double logit = std::log(share / (1.0 - share));
    return bounding == InputBounding::kTanh ? 0.5 * logit : logit;
  }
  if (below) return softplus_inverse(std::max(z - lower, kStartMargin));
  return above ? -softplus_inverse(std::max(upper - z, kStartMargin)) : z;
}

double slope(InputBounding bounding, double theta, double lower, double upper) {
  const bool below = std::isfinite(lower);
  const bool above = std::isfinite(upper);
  if (below && above) {
    const double share = share_of(bounding, theta);
    // d tanh(θ)/2 = 2 σ(2θ) (1 − σ(2θ)): twice as steep as σ(θ) at the same share.
    const double steepness = bounding == InputBounding::kTanh ? 2.0 : 1.0;
    return steepness * (upper - lower) * share * (1.0 - share);
  }
  if (below) return sigma(theta);
  return above ? sigma(-theta) : 1.0;
}

}  // namespace

BoundedInputs::BoundedInputs(InputBounding bounding, const Eigen::VectorXd& lower,
                             const Eigen::VectorXd& upper)
    : bounding_(bounding), lower_(lower), upper_(upper) {}

void BoundedInputs::inputs(const Eigen::Ref<const Eigen::VectorXd>& theta,
                           Eigen::VectorXd& z) const {
  if (bounding_ == InputBounding::kPenalty) {
    z = theta;
    return;
  }
  for (Eigen::Index i = 0; i < z.size(); ++i) {
    z[i] = to_input(bounding_, theta[i], lower_[i], upper_[i]);
  }
}

Eigen::VectorXd BoundedInputs::theta(const Eigen::VectorXd& z) const {
  Eigen::VectorXd result = z;
  if (bounding_ == InputBounding::kPenalty) return result;
  for (Eigen::Index i = 0; i < z.size(); ++i) {
    result[i] = to_theta(bounding_, z[i], lower_[i], upper_[i]);
  }
  return result;
}

void BoundedInputs::pull_back(const Eigen::Ref<const Eigen::VectorXd>& theta,
                              Eigen::Ref<Eigen::VectorXd> gradient) const {
  if (bounding_ == InputBounding::kPenalty) return;
  for (Eigen::Index i = 0; i < theta.size(); ++i) {
    gradient[i] *= slope(bounding_, theta[i], lower_[i], upper_[i]);
  }
}

double BoundedInputs::excess(const Eigen::VectorXd& z, double weight,
                             Eigen::Ref<Eigen::VectorXd> gradient) const {
  double sum = 0.0;
  for (Eigen::Index i = 0; i < z.size(); ++i) {
    const double range = upper_[i] - lower_[i];
    const double scale = std::isfinite(range) && range > 0.0 ? range : 1.0;
    const double beyond = (z[i] - std::clamp(z[i], lower_[i], upper_[i])) / scale;
    sum += beyond * beyond;
    gradient[i] += weight * 2.0 * beyond / scale;
  }
  return sum;
}

}  // namespace qsmpc::controller
