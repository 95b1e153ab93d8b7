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
  if (!applies()) return false;
  const int first = step_;
  double least = least_worth_it(plan);
  // Every other step, then both neighbours of the best.
  for (int step = kLowestStep; step <= kHighestStep; step += 2) try_step(plan, step, least);
  const int best = step_;
  try_step(plan, best - 1, least);
  try_step(plan, best + 1, least);
  return settle(first);
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

/// The excess below which another effort is worth it.
double EffortChoice::least_worth_it(const Plan& plan) {
  return evaluator_.risk()->excess(plan.risk.stages) - kWorthIt;
}

/// Moves to the step if it is another one on the ladder and its excess is below `least`, which then
/// becomes this excess.
void EffortChoice::try_step(const Plan& plan, int step, double& least) {
  if (step == step_ || step < kLowestStep || step > kHighestStep) return;
  const double excess = excess_with(plan, step);
  if (!(excess < least)) return;
  step_ = step;
  least = excess;
}

/// Tries all steps from `lowest` to `highest`. Returns whether the step has changed.
bool EffortChoice::try_steps(const Plan& plan, int lowest, int highest) {
  const int first = step_;
  double least = least_worth_it(plan);
  for (int step = lowest; step <= highest; ++step) {
    if (step != first) try_step(plan, step, least);
  }
  return settle(first);
}

/// Sets the effort of the step. Returns whether that differs from `first`.
bool EffortChoice::settle(int first) {
  evaluator_.policies().set_effort(effort_of(step_));
  return step_ != first;
}

}  // namespace qsmpc::controller
