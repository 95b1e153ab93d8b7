#include "harness/mujoco/named_model.hpp"

#include <algorithm>
#include <cstddef>

#include "harness/errors.hpp"

namespace qsmpc::harness {
namespace {

struct ElementNames {
  int count;
  const int* addresses;
};

ElementNames element_names(const mjModel& model, mjtObj type) {
  switch (type) {
    case mjOBJ_BODY:
      return {model.nbody, model.name_bodyadr};
    case mjOBJ_JOINT:
      return {model.njnt, model.name_jntadr};
    case mjOBJ_SITE:
      return {model.nsite, model.name_siteadr};
    case mjOBJ_SENSOR:
      return {model.nsensor, model.name_sensoradr};
    default:
      return {model.nu, model.name_actuatoradr};
  }
}

std::string names_of(const mjModel& model, mjtObj type) {
  const ElementNames elements = element_names(model, type);
  std::string names;
  for (int i = 0; i < elements.count; ++i) {
    const std::string name = model.names + elements.addresses[i];
    if (!name.empty()) names += (names.empty() ? "" : ", ") + name;
  }
  return names.empty() ? "none, because none has a name" : "one of " + names;
}

bool is_round(int type) {
  return type == mjGEOM_SPHERE || type == mjGEOM_ELLIPSOID || type == mjGEOM_CYLINDER ||
         type == mjGEOM_CAPSULE;
}

}  // namespace

int element_index(const NamedModel& named, mjtObj type, const std::string& name) {
  const int index = mj_name2id(&named.model, type, name.c_str());
  if (index >= 0) return index;
  const std::string kind = mju_type2Str(type);
  throw InputError({.file = named.file,
                    .key = kind + " " + name,
                    .found = "no such " + kind,
                    .expected = names_of(named.model, type)});
}

int scalar_joint(const NamedModel& named, const std::string& name) {
  const int joint = element_index(named, mjOBJ_JOINT, name);
  const int type = named.model.jnt_type[joint];
  if (type == mjJNT_SLIDE || type == mjJNT_HINGE) return joint;
  throw InputError({.file = named.file,
                    .key = "joint " + name,
                    .found = type == mjJNT_FREE ? "a free joint" : "a ball joint",
                    .expected = "a slide or hinge joint, or a quantity of a body instead"});
}

double wheel_radius(const NamedModel& named, int joint) {
  const mjModel& model = named.model;
  const int body = model.jnt_bodyid[joint];
  double radius = 0.0;
  for (int geom = 0; geom < model.ngeom; ++geom) {
    const bool turns_along = model.body_weldid[model.geom_bodyid[geom]] == body;
    const bool touches = model.geom_contype[geom] != 0 || model.geom_conaffinity[geom] != 0;
    if (turns_along && touches && is_round(model.geom_type[geom])) {
      radius = std::max(radius, model.geom_size[std::ptrdiff_t{3} * geom]);
    }
  }
  if (radius > 0.0) return radius;
  throw InputError({.file = named.file,
                    .key = "joint " + std::string(model.names + model.name_jntadr[joint]),
                    .found = "a joint that turns no wheel",
                    .expected = "a colliding sphere, ellipsoid, cylinder or capsule on its body"});
}

Eigen::Matrix3d body_rotation(const mjData& data, int body) {
  using RowMajor = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
  return Eigen::Map<const RowMajor>(data.xmat + std::ptrdiff_t{9} * body);
}

Eigen::Vector3d body_origin(const mjData& data, int body) {
  return Eigen::Map<const Eigen::Vector3d>(data.xpos + std::ptrdiff_t{3} * body);
}

Eigen::Vector3d anchor_in_body(const mjData& data, int joint, int body) {
  const Eigen::Map<const Eigen::Vector3d> anchor(data.xanchor + std::ptrdiff_t{3} * joint);
  return body_rotation(data, body).transpose() * (anchor - body_origin(data, body));
}

}  // namespace qsmpc::harness
