// How much of a discrete measure is unsafe.
#pragma once

#include <vector>

#include <Eigen/Core>

#include "controller/measure/measures.hpp"
#include "controller/regions/unsafe_set.hpp"

namespace qsmpc::controller {

/// What weights are worked out in, so that the next one allocates nothing.
struct UnsafeWeightScratch {
  Points centres;               ///< of a disc, dim x n
  Eigen::VectorXd centre;       ///< dim
  std::vector<char> is_unsafe;  ///< n
};

/// The weight of the points of `measure` (dim x n) that are unsafe, by the body, from 0 to 1: the
/// probability that the measure gives to the unsafe set.
[[nodiscard]] double unsafe_weight(const DiscreteMeasure& measure, const UnsafeSet& unsafe,
                                   Eigen::Index stage, UnsafeWeightScratch& workspace);

}  // namespace qsmpc::controller
