#include "controller/certification/error_budget.hpp"

#include <cmath>

namespace qsmpc {

std::vector<StageBudget> error_budget(const Planner& planner, const Plan& plan) {
  const double noise_w2 = planner.propagator().noise_w2();
  std::vector<StageBudget> budgets(plan.prediction.stages.size());
  budgets[0].belief = plan.belief.w2;
  budgets[0].total = plan.belief.w2;
  for (std::size_t k = 0; k + 1 < budgets.size(); ++k) {
    const double lipschitz = planner.dynamics().lipschitz(plan.policy.gains[k]);
    const double lost = plan.prediction.maps[k].compression_w2;
    budgets[k].lipschitz = lipschitz;
    budgets[k + 1].belief = lipschitz * budgets[k].belief;
    budgets[k + 1].noise = std::hypot(lipschitz * budgets[k].noise, noise_w2);
    budgets[k + 1].compression = lipschitz * budgets[k].compression + lost;
    budgets[k + 1].total = std::hypot(lipschitz * budgets[k].total, noise_w2) + lost;
  }
  return budgets;
}

}  // namespace qsmpc
