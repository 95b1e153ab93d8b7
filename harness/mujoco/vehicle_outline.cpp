#include "harness/mujoco/vehicle_outline.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <utility>

#include <Eigen/Geometry>
#include <mujoco/mujoco.h>

#include "harness/errors.hpp"
#include "harness/mujoco/geom_support.hpp"
#include "harness/mujoco/mujoco_errors.hpp"
#include "harness/mujoco/named_model.hpp"
#include "models/constants.hpp"

namespace qsmpc::harness {
namespace {

constexpr int kDirections = 360;
constexpr double kAngleStep = 2.0 * std::numbers::pi / kDirections;
// Relative to the rectangle's sides: covers the error of one-degree steps on an arc, 4e-5 of its
// radius.
constexpr double kSweepMargin = 1e-4;
constexpr double kMillimetres = 1e3;  // in a metre
constexpr double kAligned = 1e-6;     // of an axis

using Support = GeomSupport;

Eigen::Vector3d vector_at(const double* values, int element) {
  return Eigen::Map<const Eigen::Vector3d>(values + std::ptrdiff_t{3} * element);
}

struct TurningAxis {
  Eigen::Vector3d anchor;
  Eigen::Vector3d axis;
};

/// The cylinder about `turning` that contains the set for all angles.
Support turned_all_round(const Support& support, const TurningAxis& turning) {
  const Eigen::Vector3d anchor = turning.anchor;
  const Eigen::Vector3d axis = turning.axis;
  const double highest = support(axis) - axis.dot(anchor);
  const double lowest = -support(-axis) - axis.dot(anchor);
  const Eigen::Vector3d start = axis.unitOrthogonal();
  double radius = 0.0;
  for (int k = 0; k < kDirections; ++k) {
    const Eigen::Vector3d direction = Eigen::AngleAxisd(k * kAngleStep, axis) * start;
    radius = std::max(radius, support(direction) - direction.dot(anchor));
  }
  radius /= std::cos(0.5 * kAngleStep);  // the farthest point may lie between two directions
  return [=](const Eigen::Vector3d& direction) {
    const double along = direction.dot(axis);
    return direction.dot(anchor) + std::max(along * highest, along * lowest) +
           radius * (direction - along * axis).norm();
  };
}

Support turned_within(const Support& support, const TurningAxis& turning, double lower,
                      double upper) {
  const int steps = static_cast<int>(std::ceil((upper - lower) / kAngleStep));
  return [=](const Eigen::Vector3d& direction) {
    double most = -kInfinity;
    for (int k = 0; k <= steps; ++k) {
      const double angle = lower + (upper - lower) * k / std::max(steps, 1);
      const Eigen::Vector3d turned = Eigen::AngleAxisd(-angle, turning.axis) * direction;
      most = std::max(most, support(turned) + (direction - turned).dot(turning.anchor));
    }
    return most;
  };
}

/// The ball about the anchor that contains the set's bounding box.
Support turned_anyhow(const Support& support, const Eigen::Vector3d& anchor) {
  Eigen::Vector3d reach;
  for (int i = 0; i < 3; ++i) {
    const Eigen::Vector3d unit = Eigen::Vector3d::Unit(i);
    reach[i] = std::max(support(unit) - anchor[i], support(-unit) + anchor[i]);
  }
  const double radius = reach.norm();
  return [anchor, radius](const Eigen::Vector3d& direction) {
    return direction.dot(anchor) + radius * direction.norm();
  };
}

/// Extends a part's support by the motion of its joints.
class Sweep {
 public:
  Sweep(const NamedModel& named, const mjData& data) : named_(named), data_(data) {}

  [[nodiscard]] Support operator()(int geom, int carrier) const {
    Support support = geom_support(named_.model, data_, geom);
    const int outermost = outermost_limited(named_.model.geom_bodyid[geom], carrier);
    for (const int joint : joints(named_.model.geom_bodyid[geom], carrier)) {
      support = swept(support, joint, joint == outermost);
    }
    return support;
  }

 private:
  /// The joints between the body and the carrier, without the carrier's own; the innermost first.
  [[nodiscard]] std::vector<int> joints(int body, int carrier) const {
    std::vector<int> found;
    for (; body != carrier; body = named_.model.body_parentid[body]) {
      for (int k = named_.model.body_jntnum[body] - 1; k >= 0; --k) {
        found.push_back(named_.model.body_jntadr[body] + k);
      }
    }
    return found;
  }

  [[nodiscard]] int outermost_limited(int body, int carrier) const {
    int found = -1;
    for (const int joint : joints(body, carrier)) {
      const bool is_hinge = named_.model.jnt_type[joint] == mjJNT_HINGE;
      if (is_hinge && named_.model.jnt_limited[joint] != 0) found = joint;
    }
    return found;
  }

  [[nodiscard]] Support swept(const Support& support, int joint, bool within_limits) const {
    const mjModel& model = named_.model;
    const TurningAxis turning{.anchor = vector_at(data_.xanchor, joint),
                              .axis = vector_at(data_.xaxis, joint)};
    const double* range = model.jnt_range + std::ptrdiff_t{2} * joint;
    const double reference = model.qpos0[model.jnt_qposadr[joint]];
    const double lower = range[0] - reference;
    const double upper = range[1] - reference;
    switch (model.jnt_type[joint]) {
      case mjJNT_HINGE:
        if (!within_limits || upper - lower >= 2.0 * std::numbers::pi) {
          return turned_all_round(support, turning);
        }
        return turned_within(support, turning, lower, upper);
      case mjJNT_SLIDE:
        if (model.jnt_limited[joint] == 0) {
          if (turning.axis.head<2>().norm() > kAligned) refuse_slide(joint);
          return support;
        }
        return [support, axis = turning.axis, lower, upper](const Eigen::Vector3d& direction) {
          const double along = direction.dot(axis);
          return support(direction) + std::max(along * lower, along * upper);
        };
      default:
        return turned_anyhow(support, turning.anchor);
    }
  }

  [[noreturn]] void refuse_slide(int joint) const {
    throw InputError(
        {.file = named_.file,
         .key = std::string("joint ") + (named_.model.names + named_.model.name_jntadr[joint]),
         .found = "a part that slides without limits",
         .expected = "a joint range, which determines the vehicle's outline"});
  }

  const NamedModel& named_;
  const mjData& data_;
};

int body_of(const NamedModel& named, const VehicleElement& element) {
  if (!element.is_joint) return element_index(named, mjOBJ_BODY, element.name);
  return named.model.jnt_bodyid[scalar_joint(named, element.name)];
}

/// The body of `element`; if it is a joint, the joint must be of the given type, along `axis`.
int checked_body(const NamedModel& named, const mjData& data, const VehicleElement& element,
                 mjtJoint type, const Eigen::Vector3d& axis) {
  const int body = body_of(named, element);
  if (!element.is_joint) return body;
  const int joint = scalar_joint(named, element.name);
  const bool is_aligned = (vector_at(data.xaxis, joint) - axis).norm() <= kAligned;
  if (named.model.jnt_type[joint] == type && is_aligned) return body;
  throw InputError({.file = named.file,
                    .key = "joint " + element.name,
                    .found = "a joint of another type or direction",
                    .expected = type == mjJNT_HINGE ? "a hinge about the world's z axis"
                                                    : "a slide along the world's axis"});
}

/// The heading, as the system defines it, at the reference pose, rad.
double heading_of(const NamedModel& named, const mjData& data, const VehicleHeading& heading) {
  const VehicleElement& element = heading.element;
  const int body = checked_body(named, data, element, mjJNT_HINGE, Eigen::Vector3d::UnitZ());
  if (element.is_joint) {
    const int joint = scalar_joint(named, element.name);
    return named.model.qpos0[named.model.jnt_qposadr[joint]] + heading.offset;
  }
  const Eigen::Vector3d forward = body_rotation(data, body).col(0);
  return std::atan2(forward.y(), forward.x()) + heading.offset;
}

bool is_on(const mjModel& model, int body, int carrier) {
  for (; body > 0; body = model.body_parentid[body]) {
    if (body == carrier) return true;
  }
  return false;
}

VehicleOutline outline_of(const NamedModel& named, const mjData& data, const VehiclePlace& place) {
  const int x_body = checked_body(named, data, place.x, mjJNT_SLIDE, Eigen::Vector3d::UnitX());
  const int y_body = checked_body(named, data, place.y, mjJNT_SLIDE, Eigen::Vector3d::UnitY());
  const int carrier = place.heading ? body_of(named, place.heading->element) : y_body;
  const Eigen::Vector3d origin(body_origin(data, x_body).x(), body_origin(data, y_body).y(), 0.0);
  const double heading = place.heading ? heading_of(named, data, *place.heading) : 0.0;
  const Eigen::Vector3d forward(std::cos(heading), std::sin(heading), 0.0);
  const Eigen::Vector3d left(-forward.y(), forward.x(), 0.0);
  VehicleOutline outline{kInfinity, -kInfinity, kInfinity, -kInfinity};
  const Sweep sweep(named, data);
  for (int geom = 0; geom < named.model.ngeom; ++geom) {
    if (!is_on(named.model, named.model.geom_bodyid[geom], carrier)) continue;
    if (named.model.geom_type[geom] == mjGEOM_PLANE) continue;
    const Support support = sweep(geom, carrier);
    outline.front = std::max(outline.front, support(forward) - forward.dot(origin));
    outline.rear = std::min(outline.rear, -support(-forward) - forward.dot(origin));
    outline.left = std::max(outline.left, support(left) - left.dot(origin));
    outline.right = std::min(outline.right, -support(-left) - left.dot(origin));
  }
  if (outline.rear > outline.front) {
    throw InputError(
        {.file = named.file,
         .key = std::string("body ") + (named.model.names + named.model.name_bodyadr[carrier]),
         .found = "no geoms",
         .expected = "geoms that determine the vehicle's outline"});
  }
  const double margin =
      kSweepMargin * std::max(outline.front - outline.rear, outline.left - outline.right);
  // Rounded outwards to whole millimetres, which exceeds the rounding of a mesh's vertices.
  const auto below = [&](double side) {
    return std::floor((side - margin) * kMillimetres) / kMillimetres;
  };
  return {.rear = below(outline.rear),
          .front = -below(-outline.front),
          .right = below(outline.right),
          .left = -below(-outline.left)};
}

}  // namespace

VehicleOutline vehicle_outline(const mjModel_& model, const std::string& file,
                               const VehiclePlace& place) {
  const MujocoTrap trap;
  const auto deleter = [](mjData* data) { mj_deleteData(data); };
  const std::unique_ptr<mjData, decltype(deleter)> data(mj_makeData(&model), deleter);
  mj_kinematics(&model, data.get());
  return outline_of({.model = model, .file = file}, *data, place);
}

}  // namespace qsmpc::harness
