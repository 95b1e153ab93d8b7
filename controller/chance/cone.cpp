// The chance constraint of a Gaussian law and a half-space: Φ((d − 0)/σ) ≥ 1 − δ, which is a cone
// in mean and deviation, d ≥ Φ⁻¹(1 − δ) σ (Blackmore, Ono, Williams: "Chance-constrained optimal
// path planning with obstacles", 2011). Exact for linear systems with Gaussian noise and one
// half-space; several half-spaces are constrained one by one.
#include <cmath>

#include <boost/math/distributions/normal.hpp>

#include "controller/chance/back_off.hpp"

namespace qsmpc::controller {

std::unique_ptr<ChanceConstraint> make_cone_constraint(const ChanceProblem& problem) {
  const double factor =
      boost::math::quantile(boost::math::complement(boost::math::normal(), problem.settings.risk));
  return std::make_unique<BackOffConstraint>(
      problem, factor, [](double away) { return 0.5 * std::erfc(away / std::sqrt(2.0)); });
}

}  // namespace qsmpc::controller
