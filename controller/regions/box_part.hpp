// Closed boxes and half-spaces, the parts of walls and boxes, for certificates.
#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "controller/regions/safe_set.hpp"
#include "controller/regions/unsafe_region.hpp"

namespace qsmpc::controller {

/// A closed box, and the coordinates in which it is bounded.
struct BoxPart {
  Box box;
  std::vector<Eigen::Index> axes;
};

/// The half-spaces beyond the finite ends of `bounds`.
[[nodiscard]] std::vector<BoxPart> half_spaces(const Box& bounds);

[[nodiscard]] BoxPart box_part(const Box& box);

/// The probability that coordinate `axis` of z ~ law lies between the limits of `box`.
[[nodiscard]] double slab_probability(const Gaussian& law, const Box& box, Eigen::Index axis);

/// Adds bounds of P(z + e in the part), the least of those in box_part_bound.hpp, to the sums.
void add_part_probability(const SurrogateLaw& state, const BoxPart& part, RegionProbability& sum);

/// Adds the part's tail (tail_sum.hpp), from the number of standard deviations between the law's
/// mean and the part's nearest point.
void add_part_tail(const Gaussian& law, const BoxPart& part, TailSum& sum);

/// The surface of a box, bounded in the given intervals, as seen from a point.
struct BoxSurface {
  double distance = 0.0;  ///< to the surface; negative inside, −infinity without intervals
  /// Writes ∂distance/∂point times `sign` to column `i` of `slope`.
  void write_slope(const Points& points, Eigen::Index i, const std::vector<AxisInterval>& intervals,
                   double sign, Points& slope) const;
  std::size_t face = 0;  ///< inside: the interval with the nearest end
  double outward = 1.0;  ///< inside: sign of that face's normal
};

[[nodiscard]] BoxSurface box_surface(const Points& points, Eigen::Index i,
                                     const std::vector<AxisInterval>& intervals);

/// The corners of a box in the plane of two of its coordinates, counterclockwise; a coordinate of
/// -1 is unbounded.
[[nodiscard]] Eigen::Matrix2Xd rectangle_corners(const Box& box, Eigen::Index x, Eigen::Index y);

}  // namespace qsmpc::controller
