// The signs of a map, each as SVG elements on a canvas.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "controller/regions/body_outline.hpp"
#include "harness/figures/map_canvas.hpp"

namespace qsmpc::harness {

/// Data of a path through every `stride`-th of `points` and the last one, interrupted where a point
/// is not drawable. Where nothing but one point is left, a dot.
[[nodiscard]] std::string polyline_data(const MapCanvas& canvas,
                                        const std::vector<MapPoint>& points,
                                        std::size_t stride = 1);

/// An open arrowhead at point k of the path, along the way over some points about it: a single step
/// is mostly its disturbance. Empty where the way stands.
[[nodiscard]] std::string arrow_svg(const MapCanvas& canvas, const std::vector<MapPoint>& points,
                                    std::size_t k, const std::string& classes);

/// Principal axes of N(0, S), columns as long as the standard deviations along them, the longer one
/// last. Negative eigenvalues count as 0.
[[nodiscard]] Eigen::Matrix2d principal_axes(const Eigen::Matrix2d& covariance);

/// {(x − m)ᵀ S⁻¹ (x − m) ≤ −2 ln(1 − level)} as an outline; a line or a dot where S is singular.
/// `level` lies in (0, 1); all of `mean` and `covariance` is drawable.
[[nodiscard]] std::string ellipse_svg(const MapCanvas& canvas, const Eigen::Vector2d& mean,
                                      const Eigen::Matrix2d& covariance, double level,
                                      const std::string& classes);

/// Data of a path along these arcs; those that cannot be drawn are left out.
[[nodiscard]] std::string arcs_data(const MapCanvas& canvas,
                                    const std::vector<controller::Arc>& arcs);

/// A dot of the plane and its share of the weight of all dots.
struct MapDot {
  MapPoint at{};
  double share = 0.0;
};

/// Dots of an area in proportion to their share, but not smaller than can be seen and not larger
/// than hides the rest.
[[nodiscard]] std::string dots_svg(const MapCanvas& canvas, const std::vector<MapDot>& dots,
                                   const std::string& classes);

/// A round or a square mark, set off against what it lies on.
[[nodiscard]] std::string mark_svg(const MapCanvas& canvas, const MapPoint& at, bool square,
                                   const std::string& classes);

}  // namespace qsmpc::harness
