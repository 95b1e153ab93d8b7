// The keys of the vehicle: its body in the plane.
#include <algorithm>

#include <fmt/format.h>

#include "harness/scenario/keys/scenario_key.hpp"
#include "harness/scenario/vehicle_footprint.hpp"
#include "harness/scenario/yaml_text.hpp"

namespace qsmpc::harness {
namespace {

constexpr const char* kPoint = "point";
constexpr const char* kFromMjcf = "from_mjcf";
constexpr std::size_t kMostFootprintDiscs = 100;  // every particle is tested against each of them
constexpr NumberRange kDiscRadius{.least = 0.0, .most = 1e6, .above_least = true};
constexpr const char* kNoPosition = "point, because the system has no position in the plane";

bool has_position(const models::SystemDescription& system) {
  return system.position_x >= 0 && system.position_y >= 0;
}

/// Whether the footprint comes from the vehicle's file unless stated otherwise. Programs always
/// write the footprint: a recorded scenario without one predates footprints.
bool is_from_mjcf_by_default(const ScenarioReading& reading) {
  return !reading.lookup.is_recorded && !reading.scenario.plant.mjcf.empty() &&
         has_position(reading.system());
}

void read_from_mjcf(ScenarioReading& reading, Section& section, const std::string& key) {
  const Scenario::Plant& plant = reading.scenario.plant;
  if (!has_position(reading.system())) return section.note(key, kNoPosition);
  if (!reading.problems.empty()) return;  // they may concern the file or its mapping
  if (plant.mjcf.empty())
    return section.note(key, "point or discs, because there is no plant.mjcf");
  try {
    reading.scenario.safe_set.body.discs = vehicle_footprint(
        plant.mjcf, plant.mapping,
        {.description = reading.system(), .parameters = reading.scenario.model.parameters});
  } catch (const InputError& error) {
    section.note(key, "point, discs, or a MuJoCo XML file whose vehicle can be measured",
                 error.what());
  }
}

void read_discs(ScenarioReading& reading, Section& section, const KeyDescription& about) {
  const models::SystemDescription& system = reading.system();
  const std::size_t count = section.list_size(about.name);
  if (!has_position(system)) return section.note(about.name, kNoPosition);
  if (count < 1 || count > kMostFootprintDiscs) {
    section.note(about.name, fmt::format("1 to {} discs", kMostFootprintDiscs));
  }
  for (std::size_t i = 0; i < std::min(count, kMostFootprintDiscs); ++i) {
    Section item = section.item(about.name, i);
    if (item.present()) item.require("radius", "a number > 0");
    controller::Disc disc{.radius = item.number("radius", 1.0, kDiscRadius)};
    const std::optional<Eigen::VectorXd> offset = item.vector("offset", 2);
    if (offset) disc.offset = *offset;
    if (system.heading < 0 && !disc.offset.isZero(0.0)) {
      item.note("offset", "[0, 0], because the system has no heading");
      disc.offset.setZero();  // so that the following checks can run
    }
    item.refuse_unread();
    reading.scenario.safe_set.body.discs.push_back(disc);
  }
}

void read_footprint(ScenarioReading& reading, Section& section, const KeyDescription& about) {
  const models::SystemDescription& system = reading.system();
  controller::Body& body = reading.scenario.safe_set.body;
  body.x = system.position_x;
  body.y = system.position_y;
  body.heading = system.heading;
  const bool is_text = section.holds_text(about.name);
  if (section.has(about.name) && !is_text) return read_discs(reading, section, about);
  const char* fallback = is_from_mjcf_by_default(reading) ? kFromMjcf : kPoint;
  if (section.name(about.name, fallback, {kPoint, kFromMjcf}) == kFromMjcf) {
    read_from_mjcf(reading, section, about.name);
  }
}

std::optional<std::string> footprint_text(const Scenario& scenario,
                                          const models::SystemDescription& /*system*/) {
  const controller::Body& body = scenario.safe_set.body;
  if (body.is_point()) return kPoint;
  std::string out;
  for (const controller::Disc& disc : body.discs) {
    out += fmt::format("{}{{radius: {}, offset: {}}}", out.empty() ? "" : ", ",
                       yaml_number(disc.radius), yaml_list(disc.offset));
  }
  return "[" + out + "]";
}

ListValue disc_list() {
  const KeyDescription radius{
      .name = "radius", .values = {NumberValue{kDiscRadius}}, .unit = "m", .required = true};
  const KeyDescription offset{.name = "offset",
                              .values = {VectorValue{.size = Dimension::kAny, .length = 2}},
                              .words = "offset of the centre from the position: forward, left",
                              .unit = "m",
                              .fallback_words = "`[0, 0]`"};
  return list_of_values(MappingValue{{radius, offset}}, {.least = 1, .most = kMostFootprintDiscs});
}

}  // namespace

ScenarioKey vehicle_key() {
  return {
      .about = {.name = "vehicle"},
      .keys = {{.about = {.name = "footprint",
                          .values = {TextValue{.what = "point or from_mjcf",
                                               .pattern = "^(point|from_mjcf)$"},
                                     disc_list()},
                          .words =
                              "what must stay clear of the unsafe set: a list of discs `{radius: "
                              "R, offset: [FORWARD, LEFT]}` about the position, in the vehicle's "
                              "frame (offset 0 unless given); `from_mjcf`, discs that cover the "
                              "vehicle of `plant.mjcf`; or `point`, the position alone",
                          .see = "[below](#the-vehicles-body)",
                          .unit = "m",
                          .fallback_words = "`from_mjcf` where `plant.mjcf` is not empty and "
                                            "the system has a position, else `point`"},
                .read = read_footprint,
                .write = footprint_text}},
      .layout = SectionLayout::kFlow,
      .after = ReadAfter::kSystem,
      .table = "plant"};
}

}  // namespace qsmpc::harness
