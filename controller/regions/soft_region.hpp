// Walls and boxes prepared for many Gaussians of one covariance, for bound C2.
#pragma once

#include <memory>

#include "controller/regions/safe_set.hpp"
#include "controller/regions/unsafe_region.hpp"

namespace qsmpc::controller {

/// The region at or beyond the finite ends of `bounds`, as the sum over the half-spaces. Keeps a
/// reference to the centres.
[[nodiscard]] std::unique_ptr<const SoftRegion> soft_walls(const Box& bounds,
                                                           const GaussianCentres& centres);

/// A closed box. Keeps references to both arguments.
[[nodiscard]] std::unique_ptr<const SoftRegion> soft_box(const Box& box,
                                                         const GaussianCentres& centres);

}  // namespace qsmpc::controller
