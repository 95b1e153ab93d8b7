#include "harness/scenario/vehicle_footprint.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "harness/errors.hpp"
#include "harness/mujoco/mujoco_model.hpp"

namespace qsmpc::harness {
namespace {

constexpr int kMostDiscs = 5;         // every point of a measure is tested against each of them
constexpr double kMostBeyond = 0.15;  // of the width

/// The model's quantity for the position or heading `state`. `quantity`: the required quantity of a
/// body.
const PlantQuantity& placing_quantity(const std::string& mjcf, const PlantMapping& mapping,
                                      const std::string& state, const char* quantity) {
  const PlantQuantity& found = mapping.states.at(state);
  const bool is_joint = found.source == QuantitySource::kJoint;
  const bool places = found.quantity == (is_joint ? joint_quantities().front() : quantity);
  if (places && found.source != QuantitySource::kSensor && found.gain == 1.0) return found;
  throw InputError({.file = mjcf,
                    .key = "state " + state,
                    .found = "a mapping that does not place the vehicle in the world",
                    .expected = fmt::format("a joint's position or a body's {}, with gain 1, for "
                                            "vehicle.footprint: from_mjcf",
                                            quantity)});
}

VehicleElement element_of(const PlantQuantity& quantity) {
  return {.is_joint = quantity.source == QuantitySource::kJoint, .name = quantity.element};
}

VehiclePlace place_of(const std::string& mjcf, const PlantMapping& mapping,
                      const models::SystemDescription& system) {
  const auto quantity = [&](int state, const char* of_body) -> const PlantQuantity& {
    const std::string& name = system.states[static_cast<std::size_t>(state)].name;
    return placing_quantity(mjcf, mapping, name, of_body);
  };
  VehiclePlace place{.x = element_of(quantity(system.position_x, "x")),
                     .y = element_of(quantity(system.position_y, "y"))};
  if (system.heading >= 0) {
    const PlantQuantity& heading = quantity(system.heading, "yaw");
    place.heading = VehicleHeading{.element = element_of(heading), .offset = heading.offset};
  }
  return place;
}

controller::Disc disc_about_position(const VehicleOutline& outline) {
  const double along = std::max(std::abs(outline.rear), std::abs(outline.front));
  const double across = std::max(std::abs(outline.right), std::abs(outline.left));
  return {.radius = std::hypot(along, across)};
}

}  // namespace

std::vector<controller::Disc> covering_discs(const VehicleOutline& outline) {
  const Eigen::Vector2d lower(outline.rear, outline.right);
  const Eigen::Vector2d upper(outline.front, outline.left);
  const Eigen::Vector2d size = upper - lower;
  constexpr double kRounding = 1.0 + 1e-9;
  const int longer = size[1] > size[0] * kRounding ? 1 : 0;
  const double length = size[longer];
  const double half_width = 0.5 * size[1 - longer];
  int count = 0;
  double radius = 0.0;
  do {
    ++count;
    radius = std::hypot(0.5 * length / count, half_width);
  } while (count < kMostDiscs && radius - half_width > kMostBeyond * 2.0 * half_width);
  std::vector<controller::Disc> discs;
  for (int k = 0; k < count; ++k) {
    Eigen::Vector2d centre = 0.5 * (lower + upper);
    centre[longer] = lower[longer] + length * (k + 0.5) / count;
    discs.push_back({.radius = radius, .offset = centre});
  }
  return discs;
}

std::vector<controller::Disc> vehicle_footprint(const std::string& mjcf,
                                                const std::optional<PlantMapping>& mapping,
                                                const MappedSystem& system) {
  const MujocoModelPtr model = load_mujoco_model(mjcf);
  const PlantMapping used =
      mapping ? *mapping : own_plant_mapping(custom_text(*model, kMappingText), mjcf, system);
  const VehicleOutline outline =
      vehicle_outline(*model, mjcf, place_of(mjcf, used, system.description));
  if (system.description.heading < 0) return {disc_about_position(outline)};
  return covering_discs(outline);
}

}  // namespace qsmpc::harness
