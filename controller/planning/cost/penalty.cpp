#include "controller/planning/cost/penalty.hpp"

#include "controller/planning/cost/stage_kernels.hpp"

namespace qsmpc::controller {

PenaltyValue add_penalty(const Points& locations, const Eigen::VectorXd& weights,
                         const SafeSet& safe_set, const Penalty& penalty, Points& adjoint) {
  Points gradient(locations.rows(), locations.cols());
  const PenaltyValue value = penalise(PenaltyTable(safe_set, penalty), locations, weights,
                                      {0, locations.cols()}, gradient);
  adjoint += gradient;
  return value;
}

}  // namespace qsmpc::controller
