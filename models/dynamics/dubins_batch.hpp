// SIMD loops for the Dubins car's step and its reverse mode on whole batches, for the processor's
// widest vectors.
#pragma once

#include "models/dynamics/dubins.hpp"

namespace qsmpc::models {

/// As Dynamics::step.
void step_dubins(const Dubins& car, const Dynamics::BatchView& states,
                 const Dynamics::BatchView& inputs, Dynamics::BatchOut next);

/// As Dynamics::pullback.
void pullback_dubins(const Dubins& car, const Dynamics::BatchView& states,
                     const Dynamics::BatchView& next_adjoint, Dynamics::BatchOut state_adjoint,
                     Dynamics::BatchOut input_adjoint);

}  // namespace qsmpc::models
