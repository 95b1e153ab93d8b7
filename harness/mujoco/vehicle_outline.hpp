// The extent of a MuJoCo model's vehicle in the plane, relative to its position.
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

/// The system's heading as a function of the element's own angle: gain · angle + offset.
struct VehicleHeading {
  VehicleElement element;
  double offset = 0.0;  ///< rad
};

/// The elements of a model that define the vehicle's pose: for the position, the origin of a body,
/// or slides along the world's axes; for the heading, the yaw of a body, or a hinge about the
/// vertical.
struct VehiclePlace {
  VehicleElement x;
  VehicleElement y;
  std::optional<VehicleHeading> heading{};
};

/// A rectangle in the vehicle's frame, whose origin is the position and whose forward axis is the
/// heading. In whole millimetres.
struct VehicleOutline {
  double rear = 0.0;   ///< m, along forward
  double front = 0.0;  ///< m, above `rear`
  double right = 0.0;  ///< m, along left
  double left = 0.0;   ///< m, above `right`
};

/// The rectangle that encloses the ground projections of all geoms of the body that carries the
/// heading (else the position) and of its descendants, at the model's reference pose. Parts on
/// joints are swept: a steered wheel over the range of its joint, a freely turning part over the
/// full circle, a slide over its range. Of several hinges between a part and the body, the
/// outermost one with limits is swept over its range, the others over the full circle. Without a
/// heading, the axes are the world's. Throws InputError, naming `file`, where the model has no such
/// elements, where a joint is not along (about) its world axis, where a part slides horizontally
/// without limits, and where there is no geom.
[[nodiscard]] VehicleOutline vehicle_outline(const mjModel_& model, const std::string& file,
                                             const VehiclePlace& place);

}  // namespace qsmpc::harness
