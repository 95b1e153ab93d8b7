// The certificate of stage 0: a bound on the probability that the body is unsafe before any
// decision.
#pragma once

#include "controller/measure/measures.hpp"
#include "controller/regions/unsafe_set.hpp"

namespace qsmpc::controller {

/// An upper bound, at most 1, of the probability that a state x ~ `belief` (state_dim) is unsafe:
/// the sum over the body's discs and the regions, which for a point and one wall or slab is the
/// probability itself up to rounding. Derivation: bounds C3 and C4 (docs/theory/surrogate.md,
/// section 8) with the state as its own surrogate.
[[nodiscard]] double initial_risk(const Gaussian& belief, const UnsafeSet& unsafe);

}  // namespace qsmpc::controller
