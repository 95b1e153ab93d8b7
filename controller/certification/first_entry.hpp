// Bounds of the probability that the state is unsafe at any stage of a plan, below the sum of the
// stages' own: what stays unsafe from stage to stage is counted once, where it enters. Derivation:
// docs/theory/first_entry.md.
#pragma once

#include <vector>

#include "controller/certification/surrogate_bounds.hpp"
#include "controller/regions/unsafe_set.hpp"

namespace qsmpc::controller {

/// e_1 … e_horizon with P(x unsafe at any of stages 1 … k) ≤ e_1 + … + e_k for every k, each at
/// most 1; not above the sum of `of.shares` and of the probability of leaving. Holds for the law
/// that `of` is of: tilted, or of a plant with a model error. A single one bounds nothing by
/// itself.
[[nodiscard]] std::vector<double> first_entry_bounds(const UnsafeSet& unsafe,
                                                     const SurrogateBounds& of);

}  // namespace qsmpc::controller
