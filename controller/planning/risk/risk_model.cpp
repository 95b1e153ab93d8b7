#include "controller/planning/risk/risk_model.hpp"

#include <algorithm>
#include <cmath>

#include "controller/certification/statistical_linearisation.hpp"
#include "models/constants.hpp"

namespace qsmpc::controller {
namespace {

// Lower limit of the factors: a box has less probability than a half-space containing it, but not
// none.
constexpr double kLeastFactor = 0.02;
// A certificate of at least kSaysNothing that is more than kMostFactor times its tails is
// uninformative about the plan: no detour would lower it. It is replaced by kMostFactor times the
// tails plus kFloorOfNothing.
constexpr double kSaysNothing = 0.1;
constexpr double kMostFactor = 100.0;
constexpr double kFloorOfNothing = 1e-3;
// Upper limit of the factors of certificates below kSaysNothing.
constexpr double kAnyFactor = 1e6;

/// B times the slopes of the clamps under the surrogate's law at a stage.
Eigen::MatrixXd response_to_gains(const PredictedMotion& motion, Eigen::Index stage,
                                  const SurrogateStage& surrogate) {
  StageError error = StageError::none(surrogate.law.mean.size());
  error.largest() = surrogate.largest;
  const std::vector<InputLinearisation> inputs =
      linearise_inputs(motion, stage, surrogate.law, error);
  const int count = motion.dynamics.input_dim();
  Eigen::VectorXd centre(count);
  Eigen::VectorXd slopes(count);
  for (int b = 0; b < count; ++b) {
    centre[b] = inputs[b].saturation.mean;
    slopes[b] = inputs[b].saturation.slope;
  }
  Eigen::MatrixXd by_state(surrogate.law.mean.size(), surrogate.law.mean.size());
  Eigen::MatrixXd by_input(surrogate.law.mean.size(), count);
  motion.dynamics.jacobians(surrogate.law.mean, centre, by_state, by_input);
  return by_input * slopes.asDiagonal();
}

}  // namespace

RiskModel::RiskModel(const models::Dynamics& dynamics, const UnsafeSet& unsafe)
    : dynamics_(dynamics),
      unsafe_(unsafe),
      state_(dynamics.state_dim(), 1),
      input_(dynamics.input_dim(), 1),
      next_(dynamics.state_dim(), 1),
      adjoint_(dynamics.state_dim(), 1),
      state_adjoint_(dynamics.state_dim(), 1),
      input_adjoint_(dynamics.input_dim(), 1) {}

void RiskModel::hold(const PredictedMotion& motion, const std::vector<SurrogateStage>& surrogates) {
  const Policy& policy = motion.policy;
  const Eigen::Index horizon = policy.horizon();
  inputs_ = policy.inputs.rows();
  decision_.resize(0);
  held_decision_ = policy.inputs.reshaped();
  start_ = policy.states.col(0);
  first_covariance_ = motion.belief.covariance;
  noise_ = motion.noise_covariance;
  held_.resize(horizon);
  stages_.resize(horizon);
  risks_.resize(horizon);
  leaving_.resize(horizon);
  if (factors_.size() != horizon) {
    factors_.setOnes(horizon);
    floors_.setZero(horizon);
  }
  for (Eigen::Index k = 0; k < horizon; ++k) {
    const SurrogateStage& stage = surrogates[k + 1];
    Held& held = held_[k];
    held.shift = stage.law.mean - policy.states.col(k + 1);
    held.covariance = stage.law.covariance;
    held.transition = surrogates[k].transition;
    held.by_gain.resize(0, 0);
    if (held.transition.size() > 0) held.by_gain = response_to_gains(motion, k, surrogates[k]);
    leaving_[k] = stage.leaving;
    hold_discs(k + 1, stage.law, held);
  }
}

/// Places the discs for a surrogate with this law, and computes their laws.
void RiskModel::hold_discs(Eigen::Index stage, const Gaussian& law, Held& held) const {
  held.reach.clear();
  held.turn.clear();
  held.laws.clear();
  held.centres.clear();
  held.silent.clear();
  held.finite = law.covariance.allFinite();
  for (const DiscView& disc : unsafe_.discs()) {
    const DiscPlacement& placement = disc.placement;
    const Eigen::Index dim = law.mean.size();
    held.turn.push_back(Eigen::MatrixXd::Identity(dim, dim));
    held.reach.push_back(placement.reach());
    Gaussian& centre = held.laws.emplace_back(law);
    if (!placement.at_position()) {
      const int heading = placement.heading();
      const double angle = law.mean[heading] + placement.bearing();
      const double variance = std::max(0.0, law.covariance(heading, heading));
      double& reach = held.reach.back();
      reach *= std::exp(-0.5 * variance);
      held.turn.back()(placement.x(), heading) -= reach * std::sin(angle);
      held.turn.back()(placement.y(), heading) += reach * std::cos(angle);
      centre.covariance.noalias() =
          held.turn.back() * law.covariance.lazyProduct(held.turn.back().transpose());
      centre.mean[placement.x()] += reach * std::cos(angle);
      centre.mean[placement.y()] += reach * std::sin(angle);
    }
    held.centres.push_back(centre.mean);
    std::vector<double>& silent = held.silent.emplace_back();
    for (const RegionPointer& region : disc.regions) {
      silent.push_back(held.finite ? region->distance_without_tail(stage, centre) : 0.0);
    }
  }
}

void RiskModel::calibrate(const std::vector<double>& certified) {
  factors_.setOnes();
  floors_.setZero();
  risks(held_decision_);
  for (Eigen::Index k = 0; k < horizon(); ++k) {
    const double tails = stages_[k].tails;
    const double value = certified[k];
    if (value >= 1.0 && tails >= 0.5) continue;
    if (!(tails > 0.0)) {
      floors_[k] = std::min(value, kSaysNothing);
      continue;
    }
    const double factor = std::max(0.0, value - leaving_[k]) / tails;
    if (value >= kSaysNothing && factor > kMostFactor) {
      factors_[k] = kMostFactor;
      floors_[k] = kFloorOfNothing;
      continue;
    }
    factors_[k] = std::min(std::clamp(factor, kLeastFactor, kAnyFactor), value / tails);
    floors_[k] = value - factors_[k] * tails;
  }
  decision_.resize(0);
}

void RiskModel::shift_factors() {
  const Eigen::Index last = factors_.size() - 1;
  for (Eigen::Index k = 0; k < last; ++k) {
    factors_[k] = factors_[k + 1];
    floors_[k] = floors_[k + 1];
  }
  decision_.resize(0);
}

void RiskModel::forget_factors() {
  factors_.setOnes();
  floors_.setZero();
  decision_.resize(0);
}

const Eigen::VectorXd& RiskModel::risks(const Eigen::VectorXd& z) {
  if (decision_.size() == z.size() && decision_ == z) return risks_;
  roll_out(z);
  for (Eigen::Index k = 0; k < horizon(); ++k) {
    add_tails(k);
    risks_[k] = factors_[k] * stages_[k].tails + floors_[k];
  }
  decision_ = z;
  return risks_;
}

void RiskModel::roll_out(const Eigen::VectorXd& z) {
  const Eigen::Index dim = start_.size();
  const bool with_gains = z.size() > inputs_ * horizon();
  path_.resize(dim, horizon() + 1);
  path_.col(0) = start_;
  for (Eigen::Index k = 0; k < horizon(); ++k) {
    state_ = path_.col(k);
    input_ = z.segment(k * inputs_, inputs_);
    dynamics_.step(state_, input_, next_);
    path_.col(k + 1) = next_;
    Evaluated& stage = stages_[k];
    stage.mean = next_.col(0) + held_[k].shift;
    stage.by_gains = with_gains && held_[k].by_gain.size() > 0;
    if (!stage.by_gains) {
      if (with_gains) stage.covariance = held_[k].covariance;
      continue;
    }
    const Eigen::Map<const Eigen::MatrixXd> change(z.data() + inputs_ * horizon(), inputs_, dim);
    const Eigen::MatrixXd step = held_[k].transition + held_[k].by_gain * change;
    const Eigen::MatrixXd& before = k == 0 ? first_covariance_ : stages_[k - 1].covariance;
    stage.covariance = step * before * step.transpose() + noise_;
  }
}

/// Tails of stage k + 1, with their derivatives by its mean and, if the gains change it, by its
/// covariance.
void RiskModel::add_tails(Eigen::Index k) {
  Evaluated& stage = stages_[k];
  const Eigen::Index dim = stage.mean.size();
  stage.tails = 0.0;
  stage.by_mean.setZero(dim);
  if (stage.by_gains) stage.by_covariance.setZero(dim, dim);
  const bool finite = stage.by_gains ? stage.covariance.allFinite() : held_[k].finite;
  if (!finite || !stage.mean.allFinite()) {
    stage.tails = std::numeric_limits<double>::quiet_NaN();
    return;
  }
  for (std::size_t d = 0; d < unsafe_.discs().size(); ++d) add_disc_tails(k, d);
}

void RiskModel::add_disc_tails(Eigen::Index k, std::size_t d) {
  Evaluated& stage = stages_[k];
  Held& held = held_[k];
  const DiscView& disc = unsafe_.discs()[d];
  const DiscPlacement& placement = disc.placement;
  Gaussian& law = stage.by_gains ? changed_law_ : held.laws[d];
  law.mean = stage.mean;
  double cosine = 1.0;
  double sine = 0.0;
  if (!placement.at_position()) {
    const double angle = stage.mean[placement.heading()] + placement.bearing();
    cosine = std::cos(angle);
    sine = std::sin(angle);
    law.mean[placement.x()] += held.reach[d] * cosine;
    law.mean[placement.y()] += held.reach[d] * sine;
  }
  if (stage.by_gains) {
    if (placement.at_position()) {
      law.covariance = stage.covariance;
    } else {
      law.covariance.noalias() =
          held.turn[d] * stage.covariance.lazyProduct(held.turn[d].transpose());
    }
  }
  tails_.clear(stage.mean.size());
  // How far away a region stays is known for the held covariance only.
  const double moved = stage.by_gains ? kInfinity : (law.mean - held.centres[d]).norm();
  for (std::size_t r = 0; r < disc.regions.size(); ++r) {
    if (moved >= held.silent[d][r]) disc.regions[r]->add_tail(k + 1, law, tails_);
  }
  stage.tails += tails_.value();
  stage.by_mean += tails_.by_mean();
  if (!placement.at_position()) {
    stage.by_mean[placement.heading()] +=
        held.reach[d] *
        (cosine * tails_.by_mean()[placement.y()] - sine * tails_.by_mean()[placement.x()]);
  }
  if (!stage.by_gains) return;
  if (placement.at_position()) {
    stage.by_covariance += tails_.by_covariance();
  } else {
    stage.by_covariance.noalias() +=
        held.turn[d].transpose() * tails_.by_covariance().lazyProduct(held.turn[d]);
  }
}

void RiskModel::add_gradient(const Eigen::VectorXd& weights, Eigen::VectorXd& gradient) {
  adjoint_.setZero();
  for (Eigen::Index k = horizon() - 1; k >= 0; --k) {
    adjoint_.col(0) += weights[k] * factors_[k] * stages_[k].by_mean;
    state_ = path_.col(k);
    input_ = decision_.segment(k * inputs_, inputs_);
    dynamics_.pullback(state_, input_, adjoint_, state_adjoint_, input_adjoint_);
    gradient.segment(k * inputs_, inputs_) += input_adjoint_.col(0);
    adjoint_ = state_adjoint_;
  }
  if (decision_.size() > inputs_ * horizon()) pull_back_gains(weights, gradient);
}

/// Adds the derivative by the change of the gains, through the covariances.
void RiskModel::pull_back_gains(const Eigen::VectorXd& weights, Eigen::VectorXd& gradient) {
  const Eigen::Index dim = start_.size();
  const Eigen::Map<const Eigen::MatrixXd> change(decision_.data() + inputs_ * horizon(), inputs_,
                                                 dim);
  Eigen::Map<Eigen::MatrixXd> by_change(gradient.data() + inputs_ * horizon(), inputs_, dim);
  Eigen::MatrixXd by_covariance = Eigen::MatrixXd::Zero(dim, dim);
  for (Eigen::Index k = horizon() - 1; k >= 0; --k) {
    const Held& held = held_[k];
    if (!stages_[k].by_gains) {
      // The covariance after this step is held constant.
      by_covariance.setZero();
      continue;
    }
    by_covariance += weights[k] * factors_[k] * stages_[k].by_covariance;
    const Eigen::MatrixXd step = held.transition + held.by_gain * change;
    const Eigen::MatrixXd& before = k == 0 ? first_covariance_ : stages_[k - 1].covariance;
    by_change += 2.0 * held.by_gain.transpose() * by_covariance * step * before;
    by_covariance = (step.transpose() * by_covariance * step).eval();
  }
}

}  // namespace qsmpc::controller
