#include "controller/chance/back_off.hpp"

#include <algorithm>
#include <cmath>

#include "models/constants.hpp"

namespace qsmpc::controller {

BackOffConstraint::BackOffConstraint(const ChanceProblem& problem, double factor,
                                     double (*beyond)(double))
    : factor_(factor),
      beyond_(beyond),
      distances_(static_cast<std::size_t>(problem.horizon)),
      slopes_(static_cast<std::size_t>(problem.horizon)) {
  for (const DiscView& disc : problem.unsafe.discs()) {
    for (const RegionPointer& region : disc.regions) regions_.push_back({&disc, region.get()});
  }
  deviations_ = Eigen::MatrixXd::Zero(per_stage(), problem.horizon);
}

/// Distances and their slopes at the noise-free path.
void BackOffConstraint::look(Eigen::Index stage, const SampledPaths& paths) {
  const Points& states = paths.states(stage);
  state_ = states.rightCols<1>();
  Eigen::VectorXd& distances = distances_[stage - 1];
  Eigen::MatrixXd& slopes = slopes_[stage - 1];
  distances.resize(per_stage());
  slopes.resize(state_.rows(), per_stage());
  const ParticleRange one{.begin = 0, .end = 1};
  for (Eigen::Index j = 0; j < per_stage(); ++j) {
    const Meeting& meeting = regions_[j];
    nearest_.distance.setConstant(1, kInfinity);
    nearest_.slope.setZero(state_.rows(), 1);
    meeting.disc->placement.of(state_, one, centre_);
    meeting.region->lower_to_faces(stage, centre_, nearest_);
    slope_.setZero(state_.rows(), 1);
    meeting.disc->placement.pull_back(state_, one, nearest_.slope, slope_);
    distances[j] = nearest_.distance[0];
    slopes.col(j) = slope_.col(0);
  }
}

void BackOffConstraint::hold(const HeldLaws& laws, const SampledPaths& paths) {
  for (Eigen::Index stage = 1; stage <= deviations_.cols(); ++stage) {
    look(stage, paths);
    const Eigen::MatrixXd& covariance = laws.covariances[stage];
    const Eigen::MatrixXd& slopes = slopes_[stage - 1];
    for (Eigen::Index j = 0; j < per_stage(); ++j) {
      double variance = 0.0;
      for (Eigen::Index i = 0; i < slopes.rows(); ++i) {
        variance += slopes(i, j) * covariance.col(i).dot(slopes.col(j));
      }
      deviations_(j, stage - 1) = std::sqrt(std::max(0.0, variance));
    }
  }
}

void BackOffConstraint::values(Eigen::Index stage, const SampledPaths& paths,
                               Eigen::Ref<Eigen::VectorXd> values) {
  look(stage, paths);
  // A region without bounds is infinitely far away: capped, so that sums stay finite.
  values = factor_ * deviations_.col(stage - 1) - distances_[stage - 1].cwiseMin(1e9);
}

void BackOffConstraint::add_adjoint(Eigen::Index stage,
                                    const Eigen::Ref<const Eigen::VectorXd>& multipliers,
                                    SampledPaths& paths) {
  paths.adjoint(stage).rightCols<1>().noalias() -= slopes_[stage - 1] * multipliers;
}

double BackOffConstraint::believed(Eigen::Index stage, const SampledPaths& /*paths*/) const {
  double sum = 0.0;
  for (Eigen::Index j = 0; j < per_stage(); ++j) {
    const double deviation = deviations_(j, stage - 1);
    const double distance = distances_[stage - 1][j];
    if (deviation > 0.0) {
      sum += beyond_(distance / deviation);
    } else if (distance <= 0.0) {
      sum += 1.0;
    }
  }
  return std::min(1.0, sum);
}

}  // namespace qsmpc::controller
