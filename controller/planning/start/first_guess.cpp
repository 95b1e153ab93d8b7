#include "controller/planning/start/first_guess.hpp"

#include <cmath>
#include <limits>

namespace qsmpc::controller {
namespace {

// Constant inputs to try, as fractions of the way from the middle of the bounds to their ends.
constexpr double kShares[] = {-0.9, -0.45, 0.45, 0.9};

}  // namespace

bool clearly_cheaper(double cost, double than) {
  constexpr double kSwitchGain = 0.02;
  return cost < than - kSwitchGain * std::abs(than);
}

void shift_inputs(const Eigen::MatrixXd& inputs, Eigen::MatrixXd& out) {
  out = inputs;
  for (Eigen::Index k = 0; k + 1 < inputs.cols(); ++k) out.col(k) = inputs.col(k + 1);
}

FirstGuess::FirstGuess(const PlannerSettings& settings) {
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
}

bool FirstGuess::compare(const Eigen::MatrixXd* previous, const Eigen::MatrixXd& gain_change,
                         NoiseFreeCost& cost, PolicyMaker& policies) {
  double least = std::numeric_limits<double>::infinity();
  constant_ = 0;
  for (std::size_t n = 0; n < constants_.size(); ++n) {
    const double value = cost.evaluate(constants_[n], gain_change, policies);
    if (value < least) {
      least = value;
      constant_ = n;
    }
  }
  if (previous == nullptr) return false;
  shift_inputs(*previous, shifted_);
  const double value = cost.evaluate(shifted_, gain_change, policies);
  advantage_ = value - least;
  return std::isfinite(value);
}

}  // namespace qsmpc::controller
