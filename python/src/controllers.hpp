// Controllers that are objects of Python.
#pragma once

#include <nanobind/nanobind.h>

#include "harness/control/controller_object.hpp"

namespace qsmpc::python {

/// What asks `object`: its `act(situation)`, or itself where it has none; `reset(seed)` before each
/// drive, where it has one; `plans`, whether answers are plans. Throws TypeError where it cannot be
/// called. To be made, and destroyed, with the interpreter's lock.
[[nodiscard]] harness::ControllerObject controller_object(const nanobind::object& object);

}  // namespace qsmpc::python
