// The shapes of a map, each as SVG elements on a canvas.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "controller/regions/body_outline.hpp"
#include "harness/figures/map_canvas.hpp"

namespace qsmpc::harness {

/// Path data through every `stride`-th of `points` and the last one, interrupted where a point is
/// not drawable. A stretch of a single point becomes a dot.
[[nodiscard]] std::string polyline_data(const MapCanvas& canvas,
                                        const std::vector<MapPoint>& points,
                                        std::size_t stride = 1);

/// An open arrowhead at point k of the path, in the direction over several points around it, since
/// a single step is mostly disturbance. Empty if the path does not advance there.
[[nodiscard]] std::string arrow_svg(const MapCanvas& canvas, const std::vector<MapPoint>& points,
                                    std::size_t k, const std::string& classes);

/// Principal axes of N(0, S) as columns, scaled by the standard deviations along them, the longer
/// one last. Negative eigenvalues count as 0.
[[nodiscard]] Eigen::Matrix2d principal_axes(const Eigen::Matrix2d& covariance);

/// The outline of {(x − m)ᵀ S⁻¹ (x − m) ≤ −2 ln(1 − level)}; a line or a dot if S is singular.
/// `level` lies in (0, 1); `mean` and `covariance` are drawable.
[[nodiscard]] std::string ellipse_svg(const MapCanvas& canvas, const Eigen::Vector2d& mean,
                                      const Eigen::Matrix2d& covariance, double level,
                                      const std::string& classes);

/// Path data along these arcs; those that cannot be drawn are left out.
[[nodiscard]] std::string arcs_data(const MapCanvas& canvas,
                                    const std::vector<controller::Arc>& arcs);

/// A dot in the plane and its share of the weight of all dots.
struct MapDot {
  MapPoint at{};
  double share = 0.0;
};

/// Dots whose area is proportional to their share, limited so that each stays visible and none
/// hides the rest.
[[nodiscard]] std::string dots_svg(const MapCanvas& canvas, const std::vector<MapDot>& dots,
                                   const std::string& classes);

/// A round or square mark, set off from its background.
[[nodiscard]] std::string mark_svg(const MapCanvas& canvas, const MapPoint& at, bool square,
                                   const std::string& classes);

}  // namespace qsmpc::harness
