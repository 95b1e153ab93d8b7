#include "controller/certification/unicycle_fit.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "controller/certification/unicycle_residual.hpp"

namespace qsmpc::controller {
namespace {

/// max |sin δ| over |δ| ≤ reach.
double largest_sine(double reach) { return reach < 0.5 * std::numbers::pi ? std::sin(reach) : 1.0; }

/// The affine map, and the part of its residual that is known exactly.
void fit_map(const models::UnicycleStructure& unicycle, const Gaussian& law,
             const UnicycleFeedback& feedback, Eigen::Index inputs, StatisticalLinearisation& fit) {
  const Eigen::Index states = law.mean.size();
  const int heading = unicycle.heading;
  const double mean = law.mean[heading];
  const double variance = law.covariance(heading, heading);
  const double shrink = std::exp(-0.5 * variance);
  fit.transition = Eigen::MatrixXd::Identity(states, states);
  fit.transition(unicycle.x, heading) = -unicycle.reach * shrink * std::sin(mean);
  fit.transition(unicycle.y, heading) = unicycle.reach * shrink * std::cos(mean);
  fit.transition.row(heading) += unicycle.input_gain * feedback.saturation.slope * feedback.gain;
  fit.next_mean = law.mean;
  fit.next_mean[unicycle.x] += unicycle.reach * shrink * std::cos(mean);
  fit.next_mean[unicycle.y] += unicycle.reach * shrink * std::sin(mean);
  fit.next_mean[heading] += unicycle.input_gain * feedback.saturation.mean;
  fit.input_gain = Eigen::MatrixXd::Zero(states, inputs);
  fit.input_gain(heading, unicycle.input) = std::abs(unicycle.input_gain);
  const Eigen::Matrix2d moments = residual_moments(mean, variance, mean, variance, variance);
  fit.closed_form[unicycle.x] = unicycle.reach * std::sqrt(moments(0, 0));
  fit.closed_form[unicycle.y] = unicycle.reach * std::sqrt(moments(1, 1));
}

/// Bounds on the residual and on the step's slopes over the region.
void bound_residual(const models::UnicycleStructure& unicycle, const Gaussian& law,
                    const UnicycleFeedback& feedback, StatisticalLinearisation& fit) {
  const Eigen::Index states = law.mean.size();
  const int heading = unicycle.heading;
  const double variance = law.covariance(heading, heading);
  const double shrink = std::exp(-0.5 * variance);
  const double lost = -std::expm1(-0.5 * variance);
  const double along_x = std::abs(std::cos(law.mean[heading]));
  const double along_y = std::abs(std::sin(law.mean[heading]));
  // With zero reach the step does not depend on the heading, which is then unbounded.
  const double away = unicycle.reach == 0.0 ? 0.0 : feedback.away;
  for (std::size_t k = 0; k < kHigherOrders.size(); ++k) {
    const HeadingNorms norms = heading_norms(variance, k);
    fit.residual.higher(k)[unicycle.x] =
        unicycle.reach * (norms.along * along_x + norms.across * along_y);
    fit.residual.higher(k)[unicycle.y] =
        unicycle.reach * (norms.along * along_y + norms.across * along_x);
  }
  // |e^{iδ} − 1 − iδ| ≤ δ²/2, and the fit reduces 1 + iδ by the share `lost`; far from the mean,
  // the sum of both absolute values is the better bound.
  const double fitted = std::sqrt(1.0 + away * away);
  const double position =
      unicycle.reach * std::min(0.5 * away * away + lost * fitted, 1.0 + shrink * fitted);
  fit.residual.largest()[unicycle.x] = position;
  fit.residual.largest()[unicycle.y] = position;
  // The residual's slope is reach · i e^{im} (e^{iδ} − e^{−v/2}): sin δ along the mean heading,
  // cos δ − e^{−v/2} across it. That of the step itself is reach · i e^{im} e^{iδ}.
  const double turned = largest_sine(away);
  const double across = std::max(lost, shrink - std::cos(std::min(away, std::numbers::pi)));
  fit.stretch = Eigen::MatrixXd::Zero(states, states);
  fit.stretch(unicycle.x, heading) = unicycle.reach * (turned * along_x + across * along_y);
  fit.stretch(unicycle.y, heading) = unicycle.reach * (turned * along_y + across * along_x);
  fit.growth = Eigen::MatrixXd::Identity(states, states);
  fit.growth(unicycle.x, heading) = unicycle.reach * std::min(1.0, along_y + turned * along_x);
  fit.growth(unicycle.y, heading) = unicycle.reach * std::min(1.0, along_x + turned * along_y);
  const Eigen::RowVectorXd turning = unicycle.input_gain * feedback.gain;
  fit.growth.row(heading) = turning.cwiseAbs();
  fit.growth(heading, heading) = std::max(1.0, std::abs(1.0 + turning[heading]));
}

}  // namespace

void fit_unicycle(const models::UnicycleStructure& unicycle, const Gaussian& law,
                  const UnicycleFeedback& feedback, Eigen::Index inputs,
                  StatisticalLinearisation& fit) {
  fit_map(unicycle, law, feedback, inputs, fit);
  bound_residual(unicycle, law, feedback, fit);
}

}  // namespace qsmpc::controller
