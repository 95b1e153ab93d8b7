// A system whose step is given as a tape.
#pragma once

#include <memory>

#include "models/dynamics/dynamics.hpp"
#include "models/dynamics/equations/tape.hpp"

namespace qsmpc::models {

/// The largest number of states and inputs, in total, of a user-defined system.
inline constexpr int kMostCoordinates = 32;

/// tape: from the states, then the inputs, to the new states. Batches run in vector loops; the
/// Lipschitz constant is infinite if a derivative is not bounded everywhere.
[[nodiscard]] std::unique_ptr<const Dynamics> make_tape_dynamics(SystemDescription description,
                                                                 Tape tape);

}  // namespace qsmpc::models
