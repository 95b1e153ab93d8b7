#include "harness/plant/mujoco/vehicle_variation.hpp"

#include <algorithm>
#include <cstddef>
#include <memory>
#include <variant>

#include <fmt/format.h>

#include "harness/errors.hpp"

namespace qsmpc::harness {
namespace {

void refuse(const NamedModel& named, const char* what, double factor, const char* expected) {
  throw InputError({.file = named.file,
                    .key = std::string("disturbance.") + what,
                    .found = fmt::format("a factor of {:.4g}", factor),
                    .expected = expected});
}

bool has_tyres(const PlantMapping& mapping) {
  return std::ranges::any_of(mapping.loops, [](const PlantLoop& loop) {
    return std::holds_alternative<AxleForces>(loop) || std::holds_alternative<TyreForces>(loop);
  });
}

void vary_friction(const NamedModel& named, mjModel& model, const PlantMapping& mapping,
                   double factor) {
  bool any = has_tyres(mapping);
  for (int geom = 0; geom < model.ngeom; ++geom) {
    if (model.geom_contype[geom] == 0 && model.geom_conaffinity[geom] == 0) continue;
    for (int k = 0; k < 3; ++k) model.geom_friction[3 * geom + k] *= factor;
    any = true;
  }
  for (int pair = 0; pair < model.npair; ++pair) {
    for (int k = 0; k < 5; ++k) model.pair_friction[5 * pair + k] *= factor;
  }
  if (!any) refuse(named, "friction", factor, "0 for a plant without contacts or tyres");
}

void vary_mass(mjModel& model, double factor) {
  for (int body = 1; body < model.nbody; ++body) {
    model.body_mass[body] *= factor;
    for (int k = 0; k < 3; ++k) model.body_inertia[3 * body + k] *= factor;
  }
}

/// The x coordinate of an element, in the array of all elements' positions.
double& place_x(double* places, int element) { return places[std::ptrdiff_t{3} * element]; }

/// Moves the bodies of the steered wheels away from the fixed axle, whose bodies must be their
/// siblings in the body tree.
bool stretch(const NamedModel& named, mjModel& model, const AckermannLoop& loop, double factor) {
  double axle = 0.0;
  for (const std::string& name : loop.fixed_axle) {
    axle += place_x(model.body_pos, model.jnt_bodyid[scalar_joint(named, name)]);
  }
  axle /= static_cast<double>(loop.fixed_axle.size());
  for (const SteeredWheel& wheel : loop.wheels) {
    double& x = place_x(model.body_pos, model.jnt_bodyid[scalar_joint(named, wheel.joint)]);
    x = axle + factor * (x - axle);
  }
  return true;
}

bool stretch(const NamedModel& named, mjModel& model, const AxleForces& forces, double factor) {
  for (const std::string& name : {forces.front_axle, forces.rear_axle}) {
    place_x(model.site_pos, element_index(named, mjOBJ_SITE, name)) *= factor;
  }
  return true;
}

void vary_wheelbase(const NamedModel& named, mjModel& model, const PlantMapping& mapping,
                    double factor) {
  bool any = false;
  for (const PlantLoop& loop : mapping.loops) {
    if (const auto* steering = std::get_if<AckermannLoop>(&loop)) {
      any = stretch(named, model, *steering, factor);
    } else if (const auto* forces = std::get_if<AxleForces>(&loop)) {
      any = stretch(named, model, *forces, factor);
    }
  }
  if (!any) refuse(named, "wheelbase", factor, "0 for a plant whose mapping names no axles");
}

}  // namespace

void vary_vehicle(const NamedModel& named, mjModel& model, const PlantMapping& mapping,
                  const PlantVariation& variation) {
  if (variation.friction == 1.0 && variation.mass == 1.0 && variation.wheelbase == 1.0) return;
  if (variation.friction != 1.0) vary_friction(named, model, mapping, variation.friction);
  if (variation.mass != 1.0) vary_mass(model, variation.mass);
  if (variation.wheelbase != 1.0) vary_wheelbase(named, model, mapping, variation.wheelbase);
  const auto deleter = [](mjData* data) { mj_deleteData(data); };
  const std::unique_ptr<mjData, decltype(deleter)> data(mj_makeData(&model), deleter);
  mj_setConst(&model, data.get());
}

}  // namespace qsmpc::harness
