// Whether the vehicle that is drawn is the one that was driven.
#pragma once

#include <string>

#include "harness/trace/trace.hpp"

namespace qsmpc::harness {

/// A warning sentence if the vehicle's MuJoCo file, which drawings show, now compiles to a model
/// other than the one that was driven. Empty if it is the same, or if that is unknown: for an
/// analytic plant, for traces of earlier versions, and if the file is not available.
[[nodiscard]] std::string vehicle_change(const Trace& trace);

}  // namespace qsmpc::harness
