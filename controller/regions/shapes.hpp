// Factories of the shapes in the table of unsafe_set.hpp. `intervals` must be a box that check_box
// accepts.
#pragma once

#include "controller/regions/unsafe_set.hpp"

namespace qsmpc::controller {

/// The outside of a box: the points at or beyond a finite end of the interval of any coordinate.
/// Grown by more than the half-width of the box, it is the whole space.
[[nodiscard]] RegionPointer make_walls(const Box& intervals, const Growth& growth);

/// A closed box, unbounded in the coordinates whose intervals are infinite. If only position is
/// restricted, distances, probabilities (C3, C4) and tails are those of the grown box with rounded
/// corners. In all other cases, and for all other queries, it grows into a box that contains the
/// rounded one.
[[nodiscard]] RegionPointer make_box(const Box& intervals, const Growth& growth);

}  // namespace qsmpc::controller
