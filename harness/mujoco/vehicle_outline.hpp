// How far a vehicle of a MuJoCo model reaches in the plane, about its position.
#pragma once

#include <optional>
#include <string>

struct mjModel_;

namespace qsmpc::harness {

/// A body, or a joint of it, by name.
struct VehicleElement {
  bool is_joint = false;
  std::string name;
};

/// The angle that a system calls its heading, of an element's own: gain · angle + offset.
struct VehicleHeading {
  VehicleElement element;
  double offset = 0.0;  ///< rad
};

/// What of a model says where the vehicle stands: the origin of a body, or a slide along the
/// world's axis; and the yaw of a body, or a hinge about the vertical.
struct VehiclePlace {
  VehicleElement x;
  VehicleElement y;
  std::optional<VehicleHeading> heading{};
};

/// A rectangle in the vehicle's frame: the position its origin, forward along the heading. In whole
/// millimetres.
struct VehicleOutline {
  double rear = 0.0;   ///< m, along forward
  double front = 0.0;  ///< m, above `rear`
  double right = 0.0;  ///< m, along left
  double left = 0.0;   ///< m, above `right`
};

/// The rectangle about the projections on the ground of all geoms of the body that carries the
/// heading (else the position) and of the bodies on it, at the model's reference pose. Parts on
/// joints are swept: a steered wheel over the range of its joint, one that turns freely all round,
/// a slide over its range. Of several hinges between a part and the body the outermost with limits
/// is swept over its range, the others all round. Axes without heading are the world's.
/// Throws InputError, naming `file`, where the model has no such elements, where a joint is not
/// along (about) its axis of the world, where a part slides level without limits, and where there
/// is no geom.
[[nodiscard]] VehicleOutline vehicle_outline(const mjModel_& model, const std::string& file,
                                             const VehiclePlace& place);

}  // namespace qsmpc::harness
