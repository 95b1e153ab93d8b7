// Whether a vehicle is drawn as it was driven.
#pragma once

#include <string>

#include "harness/trace/trace.hpp"

namespace qsmpc::harness {

/// A sentence where the vehicle's MuJoCo file compiles to another model than the one that was
/// driven: drawings show the former. Empty where it is the same, and where that is not known: of an
/// analytic plant, of traces of earlier versions, and where the file is not to be had.
[[nodiscard]] std::string vehicle_change(const Trace& trace);

}  // namespace qsmpc::harness
