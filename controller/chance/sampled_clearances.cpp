#include "controller/chance/sampled_clearances.hpp"

namespace qsmpc::controller {

const Eigen::ArrayXd& SampledClearances::look(Eigen::Index stage, const SampledPaths& paths) {
  NearestFaces& nearest = stages_[stage - 1];
  states_ = paths.states(stage).leftCols(paths.paths());
  clearances_with_slopes(states_, unsafe_, stage, scratch_, nearest);
  nearest.distance = nearest.distance.min(1e9);
  return nearest.distance;
}

}  // namespace qsmpc::controller
