// The distributionally robust chance constraint: the conditional value at risk of every law whose
// 1-Wasserstein distance from the sampled one is at most ε. For a loss with Lipschitz constant L it
// exceeds the sampled one by at most L ε/δ, and by exactly that where the loss grows at that rate
// (Mohajerin Esfahani, Kuhn: "Data-driven distributionally robust optimization using the
// Wasserstein metric", 2018).
#include "controller/chance/tail_constraint.hpp"

namespace qsmpc::controller {

std::unique_ptr<ChanceConstraint> make_drcc_constraint(const ChanceProblem& problem) {
  const ChanceSettings& settings = problem.settings;
  return std::make_unique<TailConstraint>(
      problem, problem.unsafe.lipschitz() * settings.radius / settings.risk);
}

}  // namespace qsmpc::controller
