// The threads that the controller's loops over many particles are divided among.
//
// TBB runs them, where other work has plain Workers: these loops are short, so that threads must be
// kept between them; and they stand within each other, e.g. certificates within episodes, so that a
// thread that waits for an inner loop must take its tasks rather than block.
#pragma once

#include "controller/parallel.hpp"

namespace qsmpc::harness {

/// Runs tasks on up to `threads` threads (≥ 1; throws std::invalid_argument else), the calling one
/// among them; one thread runs them in turn. The threads live as long as the executor or a copy.
/// What a task throws passes through, once all that have begun have ended; those that have not may
/// then never run. If several throw, it is one of theirs.
[[nodiscard]] controller::Executor executor_of(int threads);

}  // namespace qsmpc::harness
