// Closed boxes and half-spaces, which walls and boxes are made of, as certificates see them.
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

/// Adds bounds of P(z + e in the part), the least of those in box_part_bound.hpp, to the sums.
void add_part_probability(const SurrogateLaw& state, const BoxPart& part, RegionProbability& sum);

/// Adds the part's tail (tail_sum.hpp): how many standard deviations the law's mean is from the
/// part's nearest point.
void add_part_tail(const Gaussian& law, const BoxPart& part, TailSum& sum);

/// Where the surface of a box, which is bounded in the given intervals, is seen from a point.
struct BoxSurface {
  double distance = 0.0;  ///< to it; less than 0 inside, and −infinity where there is no interval
  /// Writes ∂distance/∂point times `sign` to column `i` of `slope`.
  void write_slope(const Points& points, Eigen::Index i, const std::vector<AxisInterval>& intervals,
                   double sign, Points& slope) const;
  std::size_t face = 0;  ///< inside: the interval whose end is nearest
  double outward = 1.0;  ///< and its normal's sign
};

[[nodiscard]] BoxSurface box_surface(const Points& points, Eigen::Index i,
                                     const std::vector<AxisInterval>& intervals);

/// The corners of a box in the plane of two of its coordinates, counterclockwise; one that is -1 is
/// unbounded.
[[nodiscard]] Eigen::Matrix2Xd rectangle_corners(const Box& box, Eigen::Index x, Eigen::Index y);

}  // namespace qsmpc::controller
