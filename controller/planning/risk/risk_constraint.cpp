#include "controller/planning/risk/risk_constraint.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "controller/certification/first_entry.hpp"
#include "controller/certification/surrogate_bounds.hpp"
#include "models/constants.hpp"

namespace qsmpc::controller {
namespace {

// Risks below e to this power count as zero.
constexpr double kLeastLog = -60.0;

double log_ratio(double risk, double limit) {
  if (std::isnan(risk)) return risk;
  if (!(risk > 0.0)) return kLeastLog;
  // Only a risk of 0 keeps a limit of 0.
  return std::max(kLeastLog, std::log(risk) - std::log(std::max(limit, 1e-300)));
}

double sum_of(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0);
}

/// log(certificate / limit) of the limit that is exceeded most. plan: the certificate of any stage.
double excess_over(const RiskLimits& limits, const std::vector<double>& stages, double plan) {
  double excess = kLeastLog;
  if (std::isfinite(limits.first)) {
    excess = std::max(excess, log_ratio(stages.front(), limits.first));
  }
  if (std::isfinite(limits.stage)) {
    const double most = *std::max_element(stages.begin(), stages.end());
    excess = std::max(excess, log_ratio(most, limits.stage));
  }
  if (std::isfinite(limits.plan)) excess = std::max(excess, log_ratio(plan, limits.plan));
  return excess;
}

void take_stages(const SurrogateBounds& bounds, std::vector<double>& out) {
  out.clear();
  for (const RegionProbability& stage : bounds.bounds) {
    out.push_back(std::min(stage.markov, stage.smooth));
  }
}

}  // namespace

RiskConstraint::RiskConstraint(const models::Dynamics& dynamics, const PlannerSettings& settings)
    : dynamics_(dynamics),
      settings_(settings),
      unsafe_(settings.safe_set),
      bounds_(unsafe_, settings.run),
      model_(dynamics, unsafe_) {
  set_limits(settings.risk, 0);
}

void RiskConstraint::set_limits(const RiskLimits& limits, Eigen::Index period) {
  limits_ = limits;
  // A limit of 1 or more is always kept.
  for (double* limit : {&limits_.first, &limits_.stage, &limits_.plan}) {
    if (*limit >= 1.0) *limit = kInfinity;
  }
  const auto aim = [&](double limit, double set) {
    return std::isfinite(limit) ? std::min(limit, (1.0 - settings_.risk_reserve) * set) : limit;
  };
  aims_ = {.first = limits_.first,
           .stage = aim(limits_.stage, settings_.risk.stage),
           .plan = aim(limits_.plan, settings_.risk.plan)};
  period_ = period;
  bounds_.forget();
  Eigen::Index count = 0;
  if (std::isfinite(limits_.first)) ++count;
  if (std::isfinite(limits_.stage)) count += settings_.horizon;
  if (std::isfinite(limits_.plan)) ++count;
  values_.resize(count);
}

PredictedMotion RiskConstraint::motion_of(const Gaussian& belief, const Policy& policy) const {
  PredictedMotion motion{.dynamics = dynamics_,
                         .noise_covariance = settings_.noise_covariance,
                         .belief = belief,
                         .policy = policy,
                         .prediction = no_particles_};
  if (settings_.model_error) {
    motion.model_error = &*settings_.model_error;
    motion.first_period = period_;
    // From the second period on, the belief is the model's prediction for the plant.
    if (period_ > 0) motion.belief_error = &settings_.model_error->of_period(period_ - 1);
  }
  return motion;
}

void RiskConstraint::hold(const Gaussian& belief, const Policy& policy) {
  const PredictedMotion motion = motion_of(belief, policy);
  model_.hold(motion, affine_surrogates(motion));
}

void RiskConstraint::certify(const Gaussian& belief, const Policy& policy, PlanRisk& out) {
  const PredictedMotion motion = motion_of(belief, policy);
  const SurrogateBounds& bounds = bounds_.of(motion);
  model_.hold(motion, bounds.surrogates);
  take_stages(bounds, out.stages);
  out.plan = std::min(1.0, sum_of(out.stages));
  out.counted = false;
  model_.calibrate(out.stages);
  const Eigen::VectorXd z = policy.inputs.reshaped();
  const double margin = margin_;
  margin_ = 0.0;
  // After calibration the model's risks equal the certificates; beyond 1 they measure the depth.
  out.severity = values_.size() > 0 ? values(z).maxCoeff() : kLeastLog;
  if (std::isnan(out.severity)) out.severity = -kLeastLog;
  margin_ = margin;
  judge(out);
}

double RiskConstraint::excess(const Gaussian& belief, const Policy& policy) {
  std::vector<double> stages;
  take_stages(bounds_.of(motion_of(belief, policy)), stages);
  return excess(stages);
}

bool RiskConstraint::accept(const Gaussian& belief, const Policy& policy, PlanRisk& risk) {
  if (risk.kept) return true;
  if (risk.counted) return false;
  risk.counted = true;
  double plan = sum_of(risk.stages);
  if (plan > limits_.plan) {
    plan =
        std::min(plan, sum_of(first_entry_bounds(unsafe_, bounds_.of(motion_of(belief, policy)))));
  }
  const double certified = excess_over(limits_, risk.stages, plan);
  if (!(certified <= 0.0)) return false;
  risk.plan = std::min(1.0, plan);
  risk.kept = true;
  risk.severity = certified;
  return true;
}

double RiskConstraint::excess(const std::vector<double>& stages) const {
  return excess_over(aims_, stages, sum_of(stages));
}

/// The certificates, not the model, decide whether the aims are kept.
void RiskConstraint::judge(PlanRisk& out) const {
  const double certified = excess(out.stages);
  out.kept = certified <= 0.0;
  if (out.kept) out.severity = std::min(certified, out.severity);
}

void RiskConstraint::start(bool warm) {
  margin_ = 0.0;
  if (warm) {
    model_.shift_factors();
  } else {
    model_.forget_factors();
  }
}

StageRows RiskConstraint::stage_rows() const {
  return {.begin = std::isfinite(limits_.first) ? 1 : 0,
          .count = std::isfinite(limits_.stage) ? Eigen::Index{settings_.horizon} : 0};
}

const Eigen::VectorXd& RiskConstraint::values(const Eigen::VectorXd& z) {
  const Eigen::VectorXd& risks = model_.risks(z);
  Eigen::Index j = 0;
  if (std::isfinite(limits_.first)) values_[j++] = log_ratio(risks[0], aims_.first) + margin_;
  if (std::isfinite(limits_.stage)) {
    for (const double risk : risks) values_[j++] = log_ratio(risk, aims_.stage) + margin_;
  }
  if (std::isfinite(limits_.plan)) values_[j++] = log_ratio(risks.sum(), aims_.plan) + margin_;
  return values_;
}

void RiskConstraint::add_gradient(const Eigen::VectorXd& multipliers, Eigen::VectorXd& gradient) {
  if (multipliers.isZero(0.0)) return;
  const Eigen::Index horizon = model_.horizon();
  weights_.setZero(horizon);
  // The last evaluation is still cached.
  const Eigen::VectorXd& risks = model_.last_risks();
  const auto share = [&](double multiplier, double risk) {
    return multiplier > 0.0 && risk > 0.0 ? multiplier / risk : 0.0;
  };
  Eigen::Index j = 0;
  if (std::isfinite(limits_.first)) weights_[0] += share(multipliers[j++], risks[0]);
  if (std::isfinite(limits_.stage)) {
    for (Eigen::Index k = 0; k < horizon; ++k) weights_[k] += share(multipliers[j++], risks[k]);
  }
  if (std::isfinite(limits_.plan)) weights_.array() += share(multipliers[j++], risks.sum());
  model_.add_gradient(weights_, gradient);
}

double RiskConstraint::add_excess(const Eigen::VectorXd& z, double scale,
                                  Eigen::VectorXd* gradient) {
  multipliers_ = scale * values(z).cwiseMax(0.0);
  if (gradient != nullptr) add_gradient(multipliers_, *gradient);
  return 0.5 * multipliers_.dot(values_.cwiseMax(0.0));
}

double RiskConstraint::log_total(const Eigen::VectorXd& z, Eigen::VectorXd& gradient) {
  const double sum = model_.risks(z).sum();
  gradient.setZero();
  weights_.setConstant(model_.horizon(), sum > 0.0 ? 1.0 / sum : 0.0);
  model_.add_gradient(weights_, gradient);
  return std::isnan(sum) ? sum : std::max(kLeastLog, std::log(sum));
}

}  // namespace qsmpc::controller
