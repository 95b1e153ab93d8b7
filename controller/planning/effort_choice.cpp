#include "controller/planning/effort_choice.hpp"

#include <algorithm>
#include <cmath>

namespace qsmpc::controller {
namespace {

// The ladder: efforts from 10^-2 to 10^3.5, two per decade.
constexpr int kStepsPerDecade = 2;
constexpr int kLowestStep = -4;
constexpr int kHighestStep = 7;
// Least decrease of the log risk that justifies another effort, so that gains do not switch back
// and forth.
constexpr double kWorthIt = 0.05;
// A plan whose risk is below this share of its limits is not constrained by them.
constexpr double kNearLimit = 0.05;

double effort_of(int step) { return std::pow(10.0, static_cast<double>(step) / kStepsPerDecade); }

}  // namespace

EffortChoice::EffortChoice(const PlannerSettings& settings, PlanEvaluator& evaluator)
    : settings_(settings), evaluator_(evaluator) {}

bool EffortChoice::applies() const {
  return settings_.closed_loop && !settings_.feedback_gain && !settings_.feedback_effort &&
         evaluator_.risk() != nullptr;
}

void EffortChoice::reset() {
  step_ = 0;
  upwards_ = true;
  if (!settings_.feedback_effort) evaluator_.policies().set_effort(1.0);
}

bool EffortChoice::search(const Plan& plan) {
  return applies() && try_steps(plan, kLowestStep, kHighestStep);
}

bool EffortChoice::search_nearby(const Plan& plan) {
  return applies() && try_steps(plan, step_ - 1, step_ + 1);
}

bool EffortChoice::follow(const Plan& plan) {
  if (!applies()) return false;
  if (plan.risk.kept && plan.risk.severity < std::log(kNearLimit)) return false;
  upwards_ = !upwards_;
  return upwards_ ? try_steps(plan, step_, step_ + 1) : try_steps(plan, step_ - 1, step_);
}

/// Excess of the plan's inputs over their limits with gains of this effort, as a logarithm.
double EffortChoice::excess_with(const Plan& plan, int step) {
  evaluator_.policies().set_effort(effort_of(step));
  return evaluator_.excess_of(plan, policy_);
}

/// Climbs from the present step as long as that pays: upwards, to gentler gains, or else downwards.
bool EffortChoice::try_steps(const Plan& plan, int lowest, int highest) {
  const int first = step_;
  double least = evaluator_.risk()->excess(plan.risk.stages) - kWorthIt;
  const auto climb = [&](int direction, int end) {
    while (step_ != end) {
      const double excess = excess_with(plan, step_ + direction);
      if (!(excess < least)) return;
      step_ += direction;
      least = excess - kWorthIt;
    }
  };
  climb(1, std::max(first, std::min(highest, kHighestStep)));
  if (step_ == first) climb(-1, std::min(first, std::max(lowest, kLowestStep)));
  evaluator_.policies().set_effort(effort_of(step_));
  return step_ != first;
}

}  // namespace qsmpc::controller
