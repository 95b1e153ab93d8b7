// Bounds on the probability that the state is unsafe at any stage of a plan, below the sum of the
// stages' bounds: a path that stays unsafe from stage to stage is counted once, where it enters.
// Derivation: docs/theory/first_entry.md.
#pragma once

#include <vector>

#include "controller/certification/surrogate_bounds.hpp"
#include "controller/regions/unsafe_set.hpp"

namespace qsmpc::controller {

/// e_1 … e_horizon, each at most 1, with P(x unsafe at any of stages 1 … k) ≤ e_1 + … + e_k for
/// every k; their sum is at most the sum of `of.shares` plus the probability of leaving. Holds for
/// the law that `of` refers to, also if it is tilted or that of a plant with a model error. A
/// single e_k bounds nothing by itself.
[[nodiscard]] std::vector<double> first_entry_bounds(const UnsafeSet& unsafe,
                                                     const SurrogateBounds& of);

}  // namespace qsmpc::controller
