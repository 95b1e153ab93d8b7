#include "render/scene/vehicle_geometry.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "models/constants.hpp"
#include "render/gl/solid_mesh.hpp"

namespace qsmpc::render {
namespace {

constexpr int kLastVisibleGroup = 2;  // mjvOption draws groups 0 to 2 unless told otherwise
constexpr double kUprightTolerance = 1e-6;

bool is_visible(const mjModel& model, int geom) {
  return model.geom_group[geom] <= kLastVisibleGroup && model.geom_type[geom] != mjGEOM_PLANE;
}

// Half side lengths of the box about a geom, in its own axes.
SpacePoint half_sides(const mjModel& model, int geom) {
  const mjtNum* const size = model.geom_size + static_cast<std::ptrdiff_t>(3) * geom;
  switch (model.geom_type[geom]) {
    case mjGEOM_SPHERE:
      return {size[0], size[0], size[0]};
    case mjGEOM_CAPSULE:
      return {size[0], size[0], size[1] + size[0]};
    case mjGEOM_CYLINDER:
      return {size[0], size[0], size[1]};
    default:
      return {size[0], size[1], size[2]};
  }
}

SolidShape solid_shape(const mjModel& model, int geom) {
  switch (model.geom_type[geom]) {
    case mjGEOM_SPHERE:
    case mjGEOM_ELLIPSOID:
      return SolidShape::kEllipsoid;
    case mjGEOM_CAPSULE:
    case mjGEOM_CYLINDER:
      return SolidShape::kCylinder;
    default:
      return SolidShape::kBox;
  }
}

SolidPlace solid_place(const mjModel& model, const mjData& data, int geom) {
  SolidPlace place;
  place.half_sides = half_sides(model, geom);
  std::copy_n(data.geom_xpos + static_cast<std::ptrdiff_t>(3) * geom, 3, place.centre.begin());
  std::copy_n(data.geom_xmat + static_cast<std::ptrdiff_t>(9) * geom, 9, place.axes.begin());
  return place;
}

}  // namespace

bool is_vehicle(const mjModel& model, int geom) {
  return is_visible(model, geom) && model.body_weldid[model.geom_bodyid[geom]] != 0;
}

Colour colour_of(const mjModel& model, int geom) {
  const int material = model.geom_matid[geom];
  const float* const rgba = material < 0
                                ? model.geom_rgba + static_cast<std::ptrdiff_t>(4) * geom
                                : model.mat_rgba + static_cast<std::ptrdiff_t>(4) * material;
  return {rgba[0], rgba[1], rgba[2], rgba[3]};
}

std::vector<ColouredPoint> vehicle_surface(const mjModel& model, const mjData& data,
                                           const std::function<Colour(int geom)>& colour) {
  std::vector<ColouredPoint> corners;
  for (int geom = 0; geom < model.ngeom; ++geom) {
    if (!is_vehicle(model, geom)) continue;
    append_solid(solid_shape(model, geom), solid_place(model, data, geom), colour(geom), corners);
  }
  return corners;
}

std::vector<SpacePoint> box_corners(const mjModel& model, const mjData& data, int geom) {
  const SpacePoint half = half_sides(model, geom);
  const mjtNum* const centre = data.geom_xpos + static_cast<std::ptrdiff_t>(3) * geom;
  const mjtNum* const axes = data.geom_xmat + static_cast<std::ptrdiff_t>(9) * geom;
  std::vector<SpacePoint> corners(8);
  for (unsigned corner = 0; corner < 8; ++corner) {
    for (std::size_t row = 0; row < 3; ++row) {
      double value = centre[row];
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const double sign = ((corner >> axis) & 1U) != 0U ? 1.0 : -1.0;
        value += sign * axes[3 * row + axis] * half[axis];
      }
      corners[corner][row] = value;
    }
  }
  return corners;
}

double lowest_place(const mjModel& model, const mjData& data, int geom) {
  const std::vector<SpacePoint> corners = box_corners(model, data, geom);
  for (int body = model.geom_bodyid[geom]; body > 0; body = model.body_parentid[body]) {
    for (int joint = model.body_jntadr[body];
         joint < model.body_jntadr[body] + model.body_jntnum[body]; ++joint) {
      const mjtNum* const axis = data.xaxis + static_cast<std::ptrdiff_t>(3) * joint;
      const mjtNum* const anchor = data.xanchor + static_cast<std::ptrdiff_t>(3) * joint;
      if (model.jnt_type[joint] != mjJNT_HINGE || std::abs(axis[2]) > 1.0 - kUprightTolerance)
        continue;
      double reach = 0.0;
      for (const SpacePoint& corner : corners) {
        reach = std::max(
            reach, std::hypot(corner[0] - anchor[0], corner[1] - anchor[1], corner[2] - anchor[2]));
      }
      return anchor[2] - reach;
    }
  }
  double lowest = kInfinity;
  for (const SpacePoint& corner : corners) lowest = std::min(lowest, corner[2]);
  return lowest;
}

}  // namespace qsmpc::render
