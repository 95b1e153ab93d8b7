#include "controller/control/path_cost.hpp"

namespace qsmpc::controller {

CostParts path_cost(const Policy& path, const QuadraticCost& cost, PathCostScratch& scratch) {
  double state = 0.0;
  double input = 0.0;
  double terminal = 0.0;
  for (Eigen::Index k = 0; k <= path.horizon(); ++k) {
    scratch.away = path.states.col(k) - cost.target_at(k);
    if (k == path.horizon()) {
      scratch.weighted_state.noalias() = cost.terminal * scratch.away;
      terminal = scratch.away.dot(scratch.weighted_state);
    } else {
      scratch.weighted_state.noalias() = cost.state * scratch.away;
      state += 0.5 * scratch.away.dot(scratch.weighted_state);
      scratch.weighted_input.noalias() = cost.input * path.inputs.col(k);
      input += path.inputs.col(k).dot(scratch.weighted_input);
    }
  }
  return {{"state", state}, {"input", input}, {"terminal", terminal}};
}

}  // namespace qsmpc::controller
