// Penalties as loops over particles want them: the faces of the safe set that are there.
#pragma once

#include <vector>

#include "controller/planning/cost/penalty.hpp"
#include "controller/planning/safe_set.hpp"

namespace qsmpc::controller {

/// A penalty with the faces that it acts on.
class PenaltyTable {
 public:
  PenaltyTable(const SafeSet& safe_set, const Penalty& penalty);

  struct Face {
    int axis;
    double lower;
    double upper;
  };

  Penalty penalty;
  std::vector<Face> bounds;                  ///< axes that are bounded
  std::vector<std::vector<Face>> obstacles;  ///< the axes that each is bounded in
};

}  // namespace qsmpc::controller
