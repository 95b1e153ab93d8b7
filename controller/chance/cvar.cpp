// The conditional value at risk of minus the clearance: the mean of its worst share δ must not
// exceed 0, which bounds the probability of being unsafe by δ for the sampled law (Rockafellar,
// Uryasev: "Optimization of conditional value-at-risk", 2000), here at each stage separately.
#include "controller/chance/tail_constraint.hpp"

namespace qsmpc::controller {

std::unique_ptr<ChanceConstraint> make_cvar_constraint(const ChanceProblem& problem) {
  return std::make_unique<TailConstraint>(problem, 0.0);
}

}  // namespace qsmpc::controller
