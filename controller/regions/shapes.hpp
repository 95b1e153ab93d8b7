// The makers of the shapes in the table of unsafe_set.hpp. `intervals` must be a box that check_box
// takes.
#pragma once

#include "controller/regions/unsafe_set.hpp"

namespace qsmpc::controller {

/// What is outside of a box: at or beyond a finite end of the interval of any coordinate. Grown by
/// more than its half width, it is everything.
[[nodiscard]] RegionPointer make_walls(const Box& intervals, const Growth& growth);

/// A closed box, unbounded in the coordinates whose intervals are infinite. Its distances are to
/// the box with rounded corners where position alone is restricted; for everything else, and
/// otherwise, it grows into a box, which holds the rounded one.
[[nodiscard]] RegionPointer make_box(const Box& intervals, const Growth& growth);

}  // namespace qsmpc::controller
