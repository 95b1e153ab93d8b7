// The makers of the shapes in the table of unsafe_set.hpp. `intervals` must be a box that check_box
// takes.
#pragma once

#include "controller/regions/unsafe_set.hpp"

namespace qsmpc::controller {

/// What is outside of a box: at or beyond a finite end of the interval of any coordinate.
[[nodiscard]] RegionPointer make_walls(const Box& intervals);

/// A closed box, unbounded in the coordinates whose intervals are infinite.
[[nodiscard]] RegionPointer make_box(const Box& intervals);

}  // namespace qsmpc::controller
