// Completes a made-up trace with what the reader and the episodes add to real ones.
#pragma once

#include <utility>

#include "harness/assembly/assembly.hpp"
#include "harness/trace/residuals.hpp"
#include "harness/trace/trace.hpp"

namespace qsmpc::testing {

/// `trace` with its scenario's system description and the residuals of its periods filled in.
[[nodiscard]] inline harness::Trace described(harness::Trace trace) {
  const auto model = harness::model_of(trace.scenario);
  trace.system = model->description();
  harness::add_residuals(trace, *model);
  return trace;
}

}  // namespace qsmpc::testing
