// The chance constraint of every law with the given mean and covariance, by Cantelli's inequality
// P(n·x ≤ b) ≤ σ²/(σ² + d²), which equals δ at d = √((1 − δ)/δ) σ and is attained by a two-point
// law (Calafiore, El Ghaoui: "On distributionally robust chance-constrained linear programs",
// 2006).
#include <algorithm>
#include <cmath>

#include "controller/chance/back_off.hpp"

namespace qsmpc::controller {

std::unique_ptr<ChanceConstraint> make_cantelli_constraint(const ChanceProblem& problem) {
  const double risk = problem.settings.risk;
  return std::make_unique<BackOffConstraint>(
      problem, std::sqrt((1.0 - risk) / risk),
      [](double away) { return away <= 0.0 ? 1.0 : 1.0 / (1.0 + away * away); });
}

}  // namespace qsmpc::controller
