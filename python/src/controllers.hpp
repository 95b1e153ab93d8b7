// Controllers that are Python objects.
#pragma once

#include <nanobind/nanobind.h>

#include "harness/control/controller_object.hpp"

namespace qsmpc::python {

/// A controller that calls `object`: its `act(situation)`, or the object itself if it has none. It
/// also calls `reset(seed)` before each drive, if there is one; the attribute `plans` says whether
/// answers are plans. Throws TypeError if `object` cannot be called. To be created and destroyed
/// with the interpreter's lock.
[[nodiscard]] harness::ControllerObject controller_object(const nanobind::object& object);

}  // namespace qsmpc::python
