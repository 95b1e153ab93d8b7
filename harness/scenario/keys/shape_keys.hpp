// Planar shapes in a scenario: an obstacle that is {disc: {centre: [3, 4], radius: 0.5}}, an
// ellipse, a rotated box, a polygon or a half-plane.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "controller/regions/planar/planar_shape.hpp"
#include "harness/scenario/keys/key_description.hpp"
#include "harness/scenario/yaml_section.hpp"
#include "models/dynamics/dynamics.hpp"

namespace qsmpc::harness {

inline constexpr std::size_t kMostCorners = 1000;  ///< per polygon

/// Coordinates of shapes, m; wide enough for maps in a national grid.
inline constexpr NumberRange kShapePlaces{.least = -1e7, .most = 1e7};
/// Sizes of shapes, m; smaller ones are lost in the rounding of the coordinates.
inline constexpr NumberRange kShapeSizes{.least = 1e-6, .most = 1e7};

/// The keys of all shapes; an obstacle has one of them.
[[nodiscard]] std::vector<KeyDescription> shape_keys();

/// The names of all shapes.
[[nodiscard]] const std::vector<std::string>& shape_names();

/// The shapes that `obstacle` names. A state may have the same name as a shape; if its value is an
/// interval, it is taken as the state.
[[nodiscard]] std::vector<std::string> named_shapes(Section& obstacle,
                                                    const std::vector<models::Coordinate>& states);

/// The shape under the key `name` of `obstacle`; nothing, and noted problems, where it is invalid.
[[nodiscard]] std::optional<controller::PlanarShape> read_shape(Section& obstacle,
                                                                const std::string& name);

/// The polygon of `corners`, the value of `key`; nothing, and a noted problem, where the corners
/// are too many, too far away or not a polygon.
[[nodiscard]] std::optional<controller::PlanarShape> checked_polygon(
    Section& section, const std::string& key, const Eigen::Matrix2Xd& corners);

/// The shape as a mapping on one line that `read_shape` reads back bit for bit.
[[nodiscard]] std::string shape_text(const controller::PlanarShape& shape);

}  // namespace qsmpc::harness
