// The loops of ExpectedBounds over one coordinate of some particles, for the processor's widest
// vectors.
#pragma once

#include <cstddef>

#include "controller/planning/cost/penalty.hpp"
#include "controller/regions/safe_set.hpp"

namespace qsmpc::controller {

/// Number of standard deviations from a hinge beyond which its expectation is taken as zero.
inline constexpr double kFarDeviations = 8.3;

/// Σ ρ (x − r), Σ ρ (x − r)² and the range of x − r, with 0, for a reference r.
struct CoordinateMoments {
  double first = 0.0;
  double second = 0.0;
  double least = 0.0;
  double most = 0.0;
};

/// The law that a particle x_i represents: share · x_i + offset + deviation · z, z ~ N(0, 1).
struct SmoothedCoordinate {
  double share = 1.0;
  double offset = 0.0;
  double deviation = 0.0;  ///< > 0
};

/// Σ ρ E h over both faces, times the penalty's weight; its derivative by an offset of all
/// particles, and twice its derivative by the square of the deviation.
struct FaceCost {
  double value = 0.0;
  double by_offset = 0.0;
  double by_variance = 0.0;
};

/// The part ρ_i (constant + linear x_i) of a gradient.
struct FaceCorrection {
  double constant = 0.0;
  double linear = 0.0;
};

/// Of `size` particles.
[[nodiscard]] CoordinateMoments coordinate_moments(const double* x, const double* weights,
                                                   std::size_t size, double reference);

/// Adds the derivatives by the x_i, at fixed share, offset and deviation, to `gradient`.
FaceCost evaluate_faces(const AxisInterval& bounds, const SmoothedCoordinate& law,
                        const Penalty& penalty, const double* x, const double* weights,
                        std::size_t size, double* gradient);

/// Adds the correction to `gradient`.
void correct_gradient(const FaceCorrection& correction, const double* x, const double* weights,
                      std::size_t size, double* gradient);

}  // namespace qsmpc::controller
