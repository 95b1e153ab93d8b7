#include "controller/planning/first_guess.hpp"

#include <cmath>
#include <limits>

namespace qsmpc {
namespace {

// A guess must promise this fraction less cost to replace the shifted previous plan: switching
// sides of an obstacle for less makes the vehicle waver.
constexpr double kSwitchGain = 0.02;
// Constant inputs that are tried, as shares of the way from the middle of the bounds to their ends.
constexpr double kShares[] = {-0.9, -0.45, 0.45, 0.9};

}  // namespace

void shift_inputs(const Eigen::MatrixXd& inputs, Eigen::MatrixXd& out) {
  out = inputs;
  for (Eigen::Index k = 0; k + 1 < inputs.cols(); ++k) out.col(k) = inputs.col(k + 1);
}

FirstGuess::FirstGuess(const PlannerSettings& settings, const HorizonCostTerms& terms)
    : cost_(terms, settings.run) {
  const InputBounds& bounds = settings.bounds;
  const Eigen::VectorXd middle = 0.5 * (bounds.lower + bounds.upper);
  constants_.emplace_back(middle.replicate(1, settings.horizon));
  for (const double share : kShares) {
    for (Eigen::Index input = 0; input < middle.size(); ++input) {
      Eigen::VectorXd constant = middle;
      constant[input] += 0.5 * share * (bounds.upper[input] - bounds.lower[input]);
      constants_.emplace_back(constant.replicate(1, settings.horizon));
    }
  }
  noise_free_.stages.resize(settings.horizon + 1);
  noise_free_.maps.resize(settings.horizon);
  for (StageMap& map : noise_free_.maps) map.identity = true;
}

bool FirstGuess::choose(const Eigen::VectorXd& mean, const DiscreteMeasure& points,
                        const Eigen::MatrixXd* previous, const Eigen::MatrixXd& gain_change,
                        PolicyMaker& policies) {
  for (DiscreteMeasure& stage : noise_free_.stages) stage = points;
  for (StageMap& map : noise_free_.maps) map.weights = points.weights;
  bool warm = false;
  double least = std::numeric_limits<double>::infinity();
  best_ = constants_.front();
  if (previous != nullptr) {
    shift_inputs(*previous, shifted_);
    const double cost = price(mean, shifted_, gain_change, policies);
    if (std::isfinite(cost)) {
      warm = true;
      best_ = shifted_;
      least = cost - kSwitchGain * std::abs(cost);
    }
  }
  for (const Eigen::MatrixXd& constant : constants_) {
    const double cost = price(mean, constant, gain_change, policies);
    if (cost < least) {
      warm = false;
      best_ = constant;
      least = cost;
    }
  }
  return warm;
}

double FirstGuess::price(const Eigen::VectorXd& mean, const Eigen::MatrixXd& inputs,
                         const Eigen::MatrixXd& gain_change, PolicyMaker& policies) {
  policies.make(mean, inputs, gain_change, policy_);
  cost_.hold(noise_free_, policy_);
  flat_ = inputs.reshaped();
  const double value = cost_.price(flat_);
  // A guess whose cost is not a number must lose every comparison.
  return std::isnan(value) ? std::numeric_limits<double>::infinity() : value;
}

}  // namespace qsmpc
