#include "controller/planning/constraints/stage_constraint.hpp"

namespace qsmpc::controller {

const std::vector<StageConstraintEntry>& stage_constraints() {
  static const std::vector<StageConstraintEntry> table = {
      {.name = "bounds",
       .summary = "every particle within the bounds of the safe set",
       .make = make_bounds_constraint},
  };
  return table;
}

}  // namespace qsmpc::controller
