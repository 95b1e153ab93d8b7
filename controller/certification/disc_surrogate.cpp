#include "controller/certification/disc_surrogate.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "controller/certification/unicycle_residual.hpp"

namespace qsmpc::controller {
namespace {

// |e^{ia} − e^{ib}| is at most |a − b|, and at most this.
constexpr double kMostTurn = 2.0;

/// Absolute x and y components of the offset's mean direction.
struct TurnShares {
  double along_x;
  double along_y;
};

}  // namespace

DiscSurrogate disc_surrogate(const SurrogateStage& stage, const DiscPlacement& placement) {
  DiscSurrogate disc{.law = stage.law, .turn = {}, .error = stage.error, .higher = stage.higher};
  if (placement.at_position()) return disc;
  const int heading = placement.heading();
  const double reach = placement.reach();
  const double mean = stage.law.mean[heading] + placement.bearing();
  const double variance = std::max(0.0, stage.law.covariance(heading, heading));
  const double fitted = reach * std::exp(-0.5 * variance);
  disc.law.mean[placement.x()] += fitted * std::cos(mean);
  disc.law.mean[placement.y()] += fitted * std::sin(mean);
  const Eigen::Index dim = stage.law.mean.size();
  Eigen::MatrixXd turn = Eigen::MatrixXd::Identity(dim, dim);
  turn(placement.x(), heading) -= fitted * std::sin(mean);
  turn(placement.y(), heading) += fitted * std::cos(mean);
  disc.law.covariance = turn * stage.law.covariance * turn.transpose();
  disc.law.covariance = 0.5 * (disc.law.covariance + disc.law.covariance.transpose()).eval();
  disc.turn = std::move(turn);

  const Eigen::Matrix2d moments = residual_moments(mean, variance, mean, variance, variance);
  const double turned = reach * std::min(kMostTurn, stage.error[heading]);
  disc.error[placement.x()] += turned + reach * std::sqrt(std::max(0.0, moments(0, 0)));
  disc.error[placement.y()] += turned + reach * std::sqrt(std::max(0.0, moments(1, 1)));
  const TurnShares share{.along_x = std::abs(std::cos(mean)), .along_y = std::abs(std::sin(mean))};
  for (std::size_t k = 0; k < kHigherOrders.size(); ++k) {
    const HeadingNorms norms = heading_norms(variance, k);
    const double differs = reach * std::min(kMostTurn, stage.higher[k][heading]);
    disc.higher[k][placement.x()] +=
        differs + reach * (norms.along * share.along_x + norms.across * share.along_y);
    disc.higher[k][placement.y()] +=
        differs + reach * (norms.along * share.along_y + norms.across * share.along_x);
  }
  return disc;
}

Eigen::MatrixXd given_heading(Eigen::MatrixXd covariance, Eigen::Index heading) {
  const double variance = covariance(heading, heading);
  if (variance > 0.0) {
    const Eigen::VectorXd cross = covariance.col(heading);
    covariance -= cross * cross.transpose() / variance;
  }
  covariance.row(heading).setZero();
  covariance.col(heading).setZero();
  return covariance;
}

Eigen::MatrixXd disc_smoothing(const PredictedMotion& motion, Eigen::Index stage,
                               const std::vector<Eigen::Index>& axes,
                               const DiscPlacement& placement, const PathTilt& tilt) {
  if (placement.at_position()) return smoothing_covariance(motion, stage, axes, tilt);
  const Eigen::Index heading = placement.heading();
  std::vector<Eigen::Index> with_heading = axes;
  if (std::find(axes.begin(), axes.end(), heading) == axes.end()) with_heading.push_back(heading);
  Eigen::MatrixXd smoothing = smoothing_covariance(motion, stage, with_heading, tilt);
  // The turn's residual depends on the surrogate's heading, of which the smoothing part must be
  // independent: this is what the part's own heading does not explain.
  return given_heading(std::move(smoothing), heading);
}

}  // namespace qsmpc::controller
