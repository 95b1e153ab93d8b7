// Shapes of the plane of position in a scenario: an obstacle that is {disc: {centre: [3, 4],
// radius: 0.5}}, an ellipse, a turned box, a polygon or a half-plane.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "controller/regions/planar/planar_shape.hpp"
#include "harness/scenario/keys/key_description.hpp"
#include "harness/scenario/yaml_section.hpp"
#include "models/dynamics/dynamics.hpp"

namespace qsmpc::harness {

inline constexpr std::size_t kMostCorners = 1000;  ///< of a polygon

/// Places of shapes, m; those of maps in a national grid are below.
inline constexpr NumberRange kShapePlaces{.least = -1e7, .most = 1e7};
/// Their sizes, m; what is smaller is lost in the rounding of its place.
inline constexpr NumberRange kShapeSizes{.least = 1e-6, .most = 1e7};

/// The keys of shapes, of which an obstacle has one.
[[nodiscard]] std::vector<KeyDescription> shape_keys();

/// Their names.
[[nodiscard]] const std::vector<std::string>& shape_names();

/// The shapes that `obstacle` names. A state may be called as a shape is: what is then written as
/// an interval is one.
[[nodiscard]] std::vector<std::string> named_shapes(Section& obstacle,
                                                    const std::vector<models::Coordinate>& states);

/// The shape under the key `name` of `obstacle`; nothing, and noted problems, where that is none.
[[nodiscard]] std::optional<controller::PlanarShape> read_shape(Section& obstacle,
                                                                const std::string& name);

/// The polygon of `corners`, which are the value of `key`; nothing, and a noted problem, where they
/// are too many, too far away or no polygon.
[[nodiscard]] std::optional<controller::PlanarShape> checked_polygon(
    Section& section, const std::string& key, const Eigen::Matrix2Xd& corners);

/// The shape as a mapping on one line that `read_shape` takes, of the same values bit for bit.
[[nodiscard]] std::string shape_text(const controller::PlanarShape& shape);

}  // namespace qsmpc::harness
