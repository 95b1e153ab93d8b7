// Walls and boxes as many Gaussians of one covariance see them, for bound C2.
#pragma once

#include <memory>

#include "controller/regions/safe_set.hpp"
#include "controller/regions/unsafe_region.hpp"

namespace qsmpc::controller {

/// What is at or beyond a finite end of `bounds`, as the sum over the half-spaces. Refers to the
/// centres.
[[nodiscard]] std::unique_ptr<const SoftRegion> soft_walls(const Box& bounds,
                                                           const GaussianCentres& centres);

/// A closed box. Refers to both.
[[nodiscard]] std::unique_ptr<const SoftRegion> soft_box(const Box& box,
                                                         const GaussianCentres& centres);

}  // namespace qsmpc::controller
