#include "controller/planning/coarse_cost.hpp"

#include <algorithm>
#include <cmath>

#include "controller/planning/planner_propagator.hpp"

namespace qsmpc::controller {
namespace {

// Largest number of points of the belief, of parts of the noise, and of points kept.
constexpr int kFewPoints = 12;
// With at least this many times as many points kept, the coarse cost pays.
constexpr int kManyTimes = 4;

/// For the propagator.
PlannerSettings with_few_points(PlannerSettings settings) {
  settings.noise_points = std::min(settings.noise_points, kFewPoints);
  settings.compressed_points = std::min(settings.compressed_points, kFewPoints);
  return settings;
}

}  // namespace

bool CoarseCost::pays(const PlannerSettings& settings) {
  return settings.compressed_points >= kManyTimes * kFewPoints;
}

CoarseCost::CoarseCost(const models::Dynamics& dynamics, const PlannerSettings& settings,
                       const HorizonCostTerms& terms)
    : dynamics_(dynamics),
      settings_(settings),
      within_(Eigen::MatrixXd::Zero(dynamics.state_dim(), dynamics.state_dim())),
      quantiser_(dynamics.state_dim(), std::min(settings.state_points, kFewPoints),
                 settings.quantiser),
      propagator_(planner_propagator(with_few_points(settings))),
      cost_({.dynamics = terms.dynamics,
             .safe_set = terms.safe_set,
             .cost = terms.cost,
             .penalty = terms.penalty,
             .noise_covariance = terms.noise_covariance,
             .within_covariance = within_},
            settings.run) {}

void CoarseCost::hold(const Gaussian& belief, const Policy& policy) {
  quantiser_.quantise(belief, belief_);
  within_ = belief_.within_covariance;
  predict(dynamics_, *propagator_, belief_.measure, policy, settings_.run, scratch_, prediction_);
  cost_.freeze_assignments(prediction_, policy);
}

bool CoarseCost::match(const Eigen::VectorXd& z, double value, const Eigen::VectorXd& gradient) {
  slope_.resize(z.size());
  const double own = cost_.evaluate(z, slope_);
  slope_ = gradient - slope_;
  constant_ = value - own - slope_.dot(z);
  return std::isfinite(constant_) && slope_.allFinite();
}

double CoarseCost::evaluate(const Eigen::VectorXd& z) {
  return cost_.evaluate(z) + slope_.dot(z) + constant_;
}

double CoarseCost::evaluate(const Eigen::VectorXd& z, Eigen::VectorXd& gradient) {
  const double own = cost_.evaluate(z, gradient);
  gradient += slope_;
  return own + slope_.dot(z) + constant_;
}

}  // namespace qsmpc::controller
