// The system whose step a tape is.
#pragma once

#include <memory>

#include "models/dynamics/dynamics.hpp"
#include "models/dynamics/equations/tape.hpp"

namespace qsmpc::models {

/// States and inputs that a system of one's own may have in all.
inline constexpr int kMostCoordinates = 32;

/// tape: of the states, then the inputs, to the new states. Its batches go through vector loops;
/// its Lipschitz constant is infinite where a derivative is not bounded everywhere.
[[nodiscard]] std::unique_ptr<const Dynamics> make_tape_dynamics(SystemDescription description,
                                                                 Tape tape);

}  // namespace qsmpc::models
