// How much of a discrete measure is unsafe.
#pragma once

#include <vector>

#include <Eigen/Core>

#include "controller/measure/measures.hpp"
#include "controller/regions/unsafe_set.hpp"

namespace qsmpc::controller {

/// Scratch of unsafe_weight; reused, it makes the next call allocation-free.
struct UnsafeWeightScratch {
  Points centres;               ///< of a disc, dim x n
  Eigen::VectorXd centre;       ///< dim
  std::vector<char> is_unsafe;  ///< n
};

/// The total weight, from 0 to 1, of the points of `measure` (dim x n) at which the body is unsafe:
/// the measure's probability of the unsafe set.
[[nodiscard]] double unsafe_weight(const DiscreteMeasure& measure, const UnsafeSet& unsafe,
                                   Eigen::Index stage, UnsafeWeightScratch& workspace);

}  // namespace qsmpc::controller
