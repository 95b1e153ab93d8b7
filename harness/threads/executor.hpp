// The threads that run the controller's loops over many particles.
//
// These loops run on TBB, other work on plain Workers. The loops are short, so threads must be kept
// between them. They are also nested, e.g. certificates within episodes, so a thread that waits for
// an inner loop must take on its tasks rather than block.
#pragma once

#include "controller/parallel.hpp"

namespace qsmpc::harness {

/// Runs tasks on up to `threads` threads (≥ 1; otherwise throws std::invalid_argument), including
/// the calling one; a single thread runs them in turn. The threads live as long as the executor or
/// a copy of it. An exception of a task is rethrown once all tasks that have begun have ended; the
/// others may then never run. If several tasks throw, one of their exceptions is rethrown.
[[nodiscard]] controller::Executor executor_of(int threads);

}  // namespace qsmpc::harness
