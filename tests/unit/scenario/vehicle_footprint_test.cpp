#include "harness/scenario/vehicle_footprint.hpp"

#include <fstream>
#include <ostream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "harness/mujoco/mujoco_model.hpp"
#include "harness/scenario/scenario_file.hpp"
#include "models/constants.hpp"
#include "tests/unit/scenario/scenario_fixture.hpp"

namespace qsmpc::harness {
namespace vehicle_footprint_test {

using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// Added to the outline by sweeps (1e-4 of its length) and by rounding to whole millimetres.
constexpr double kSlack = 1.6e-3;  // m

Scenario scenario_with(const std::string& system, const std::string& vehicle,
                       const std::vector<std::string>& more = {}) {
  const std::string zeros = system == "bicycle" ? "[0, 0, 0, 0, 0, 0]" : "[0, 0, 0]";
  return parse_scenario("name: body\nmodel: {system: " + system + "}\ninitial_state: {mean: " +
                            zeros + "}\ntarget: {state: " + zeros + "}\n" + vehicle,
                        {.file = "t.yaml", .overrides = more});
}

std::vector<controller::Disc> discs_of(const std::string& vehicle,
                                       const std::vector<std::string>& more = {}) {
  return scenario_with("dubins", vehicle, more).safe_set.body.discs;
}

// Computed by hand from the files: the outline, and with n discs along L the radius hypot(L/2n,
// W/2).
struct ShippedBody {
  std::string name;
  std::string system;
  std::string mjcf;
  VehicleOutline outline;
  int discs;
};

std::ostream& operator<<(std::ostream& out, const ShippedBody& body) { return out << body.mjcf; }

class ShippedFootprint : public ::testing::TestWithParam<ShippedBody> {};

TEST_P(ShippedFootprint, is_of_discs_about_the_outline_of_the_geoms) {
  const ShippedBody& body = GetParam();
  const VehicleOutline& o = body.outline;
  std::vector<std::string> more{"plant={kind: mujoco, mjcf: " + body.mjcf + "}"};
  if (body.mjcf == "differential_robot.xml") {
    more = {
        "plant={kind: mujoco, mjcf: differential_robot.xml, state: {x: {body: base, quantity: "
        "x}, y: {body: base, quantity: y}, heading: {body: base, quantity: yaw}}, input: "
        "{yaw_rate: [{actuator: left_motor}]}}"};
  }
  const Scenario scenario = scenario_with(body.system, "vehicle: {footprint: from_mjcf}\n", more);
  const std::vector<controller::Disc>& discs = scenario.safe_set.body.discs;
  ASSERT_EQ(std::ssize(discs), body.discs);
  const double part = (o.front - o.rear) / body.discs;
  for (int k = 0; k < body.discs; ++k) {
    const controller::Disc& disc = discs[static_cast<std::size_t>(k)];
    EXPECT_NEAR(disc.radius, std::hypot(0.5 * part, 0.5 * (o.left - o.right)), kSlack);
    EXPECT_NEAR(disc.offset.x(), o.rear + part * (k + 0.5), kSlack);
    EXPECT_NEAR(disc.offset.y(), 0.5 * (o.left + o.right), kSlack);
  }
  EXPECT_EQ(scenario.safe_set.body.x, 0);
  EXPECT_EQ(scenario.safe_set.body.y, 1);
  EXPECT_EQ(scenario.safe_set.body.heading, 2);
}

INSTANTIATE_TEST_SUITE_P(
    Files, ShippedFootprint,
    ::testing::Values(
        // Rear: the wing, 0.080 + 0.028 cos 0.12 + 0.004 sin 0.12. Front: the bumper. Sides: a
        // front wheel at 0.7 rad, 0.11 + 0.06 sin 0.7 + 0.022 cos 0.7.
        ShippedBody{"dubins_car", "dubins", "dubins_car.xml", {-0.1083, 0.414, -0.1655, 0.1655}, 2},
        ShippedBody{"dubins_planar", "dubins", "dubins_planar.xml", {-0.09, 0.40, -0.12, 0.12}, 3},
        // Rear: the tail lamps. Sides: a front wheel at 1.2 rad, 0.76 + 0.32 sin 1.2 + 0.11 cos
        // 1.2.
        ShippedBody{"bicycle_car", "bicycle", "bicycle_car.xml", {-2.62, 1.9, -1.0981, 1.0981}, 3},
        ShippedBody{"bicycle_planar", "bicycle", "bicycle_planar.xml", {-2.6, 1.9, -0.88, 0.88}, 4},
        ShippedBody{"robot", "dubins", "differential_robot.xml", {-0.15, 0.27, -0.21, 0.21}, 2}),
    [](const auto& tested) { return tested.param.name; });

TEST(CoveringDiscs, leave_no_place_of_the_outline_free) {
  for (const VehicleOutline& outline :
       {VehicleOutline{-1.0, 3.0, -0.5, 0.9}, VehicleOutline{0.0, 0.3, -2.0, 2.0},
        VehicleOutline{-20.0, 20.0, -1.0, 1.0}}) {
    const std::vector<controller::Disc> discs = covering_discs(outline);
    EXPECT_LE(discs.size(), 5U);
    for (int i = 0; i <= 40; ++i) {
      for (int j = 0; j <= 40; ++j) {
        const Eigen::Vector2d place(outline.rear + (outline.front - outline.rear) * i / 40.0,
                                    outline.right + (outline.left - outline.right) * j / 40.0);
        double nearest = kInfinity;
        for (const controller::Disc& disc : discs) {
          nearest = std::min(nearest, (place - disc.offset).norm() - disc.radius);
        }
        EXPECT_LE(nearest, 1e-12) << place.transpose();
      }
    }
  }
}

/// A body at (1, 2) heading along y, carrying `parts`.
std::string vehicle_file(const TemporaryFolder& folder, const std::string& parts) {
  const std::string path = folder / "own.xml";
  std::ofstream(path) << R"(<mujoco><compiler angle="radian" autolimits="true"/><worldbody>
    <geom name="ground" type="plane" size="0 0 1"/>
    <body name="base" pos="1 2 0.5" euler="0 0 1.5707963267948966"><freejoint/>
    <geom type="box" size="0.4 0.1 0.1" mass="1"/>)"
                      << parts << "</body></worldbody></mujoco>\n";
  return path;
}

VehicleOutline own_outline(const std::string& parts) {
  const TemporaryFolder folder;
  const std::string path = vehicle_file(folder, parts);
  const VehicleElement base{.is_joint = false, .name = "base"};
  return vehicle_outline(*load_mujoco_model(path), path,
                         {.x = base, .y = base, .heading = VehicleHeading{.element = base}});
}

void expect_outline(const VehicleOutline& found, const VehicleOutline& expected) {
  EXPECT_NEAR(found.rear, expected.rear, kSlack);
  EXPECT_NEAR(found.front, expected.front, kSlack);
  EXPECT_NEAR(found.right, expected.right, kSlack);
  EXPECT_NEAR(found.left, expected.left, kSlack);
}

TEST(VehicleOutline, is_in_the_vehicles_own_frame) {
  expect_outline(own_outline(""), {-0.4, 0.4, -0.1, 0.1});
  expect_outline(own_outline(R"(<geom type="sphere" pos="0.5 0.1 0" size="0.2"/>)"),
                 {-0.4, 0.7, -0.1, 0.3});
  expect_outline(own_outline(R"(<geom type="capsule" fromto="0 0 0 -0.6 0 0" size="0.05"/>)"),
                 {-0.65, 0.4, -0.1, 0.1});
}

TEST(VehicleOutline, holds_what_its_parts_can_reach) {
  // A bar of 0.6 m on a hinge 0.3 m ahead: without limits it turns all the way round; with limits
  // from -0.5 to 0.5 rad it reaches 0.3 + 0.6 ahead and 0.6 sin 0.5 sideways; on a slide it moves
  // ahead within those limits.
  const auto bar = [](const std::string& joint) {
    return R"(<body pos="0.3 0 0"><joint )" + joint +
           R"(/><geom type="box" pos="0.3 0 0" size="0.3 0.0001 0.01" mass="1"/></body>)";
  };
  expect_outline(own_outline(bar(R"(type="hinge" axis="0 0 1")")), {-0.4, 0.9, -0.6, 0.6});
  const double aside = 0.6 * std::sin(0.5);
  expect_outline(own_outline(bar(R"(type="hinge" axis="0 0 1" range="-0.5 0.5")")),
                 {-0.4, 0.9, -aside, aside});
  expect_outline(own_outline(bar(R"(type="slide" axis="1 0 0" range="-0.1 0.2")")),
                 {-0.4, 1.1, -0.1, 0.1});
  expect_outline(own_outline(bar(R"(type="ball")")), {-0.4, 0.9, -0.6, 0.6});
  EXPECT_THROW((void)own_outline(bar(R"(type="slide" axis="1 0 0")")), InputError);
}

TEST(Vehicle, is_the_one_of_the_mujoco_file_unless_the_scenario_says_otherwise) {
  const std::vector<controller::Disc> car = discs_of("");
  EXPECT_EQ(car.size(), 2U);
  EXPECT_EQ(discs_of("plant: {kind: analytic}\n").size(), car.size());
  EXPECT_EQ(discs_of("plant: {mjcf: dubins_planar.xml}\n").size(), 3U);
  EXPECT_THAT(discs_of("vehicle: {footprint: point}\n"), IsEmpty());
  EXPECT_THAT(discs_of("plant: {kind: analytic, mjcf: \"\"}\n"), IsEmpty());
}

TEST(Vehicle, is_a_point_in_recorded_scenarios_that_know_no_footprint) {
  const std::string text =
      "name: old\nmodel: {system: dubins}\ninitial_state: {mean: [0, 0, 0]}\n"
      "target: {state: [5, 0, 0]}\n";
  EXPECT_FALSE(parse_scenario(text).safe_set.body.is_point());
  EXPECT_TRUE(parse_scenario(text, {.is_recorded = true}).safe_set.body.is_point());
  EXPECT_TRUE(parse_scenario(text, {.files_must_exist = false}).safe_set.body.is_point());
}

TEST(Vehicle, is_written_as_the_discs_that_it_came_to) {
  for (const char* vehicle :
       {"vehicle: {footprint: from_mjcf}\n", "vehicle: {footprint: point}\n",
        "vehicle: {footprint: [{radius: 0.1, offset: [0.3, -0.2]}, {radius: 0.7}]}\n"}) {
    const Scenario scenario = scenario_with("dubins", vehicle);
    const Scenario again = parse_scenario(to_yaml(scenario));
    ASSERT_EQ(again.safe_set.body.discs.size(), scenario.safe_set.body.discs.size()) << vehicle;
    for (std::size_t k = 0; k < again.safe_set.body.discs.size(); ++k) {
      EXPECT_EQ(again.safe_set.body.discs[k].radius, scenario.safe_set.body.discs[k].radius);
      EXPECT_EQ(again.safe_set.body.discs[k].offset, scenario.safe_set.body.discs[k].offset);
    }
    EXPECT_EQ(to_yaml(scenario).find("from_mjcf"), std::string::npos);
  }
  EXPECT_THAT(to_yaml(scenario_with("dubins", "vehicle: {footprint: [{radius: 0.5}]}\n")),
              HasSubstr("vehicle: {footprint: [{radius: 0.5, offset: [0, 0]}]}"));
}

struct BrokenVehicle {
  std::string name;
  std::string vehicle;
  std::string key;
  std::string expected;
  std::string system = "dubins";
};

class RefusedVehicle : public ::testing::TestWithParam<BrokenVehicle> {};

TEST_P(RefusedVehicle, is_named_with_file_line_and_key) {
  const BrokenVehicle& broken = GetParam();
  static const std::map<std::string, std::string> means = {
      {"dubins", "[0, 0, 0]"}, {"double_integrator", "[0, 0]"}, {"point_mass", "[0, 0, 0, 0]"}};
  const std::string& mean = means.at(broken.system);
  const InputError::Where where =
      refusal_of("name: a\nmodel: {system: " + broken.system + "}\ninitial_state: {mean: " + mean +
                 "}\ntarget: {state: " + mean + "}\n" + broken.vehicle);
  EXPECT_EQ(where.file, "t.yaml");
  EXPECT_EQ(where.line, 5);
  EXPECT_EQ(where.key, broken.key);
  EXPECT_THAT(where.expected, HasSubstr(broken.expected));
}

INSTANTIATE_TEST_SUITE_P(
    Files, RefusedVehicle,
    ::testing::Values(
        BrokenVehicle{"unknown_word", "vehicle: {footprint: pont}", "vehicle.footprint", "point"},
        BrokenVehicle{"no_discs", "vehicle: {footprint: []}", "vehicle.footprint", "1 to 100"},
        BrokenVehicle{"no_radius", "vehicle: {footprint: [{offset: [0, 0]}]}",
                      "vehicle.footprint.0.radius", "number > 0"},
        BrokenVehicle{"radius_of_zero", "vehicle: {footprint: [{radius: 0}]}",
                      "vehicle.footprint.0.radius", "> 0"},
        BrokenVehicle{"infinite_radius", "vehicle: {footprint: [{radius: .inf}]}",
                      "vehicle.footprint.0.radius", "> 0"},
        BrokenVehicle{"infinite_offset", "vehicle: {footprint: [{radius: 1, offset: [.inf, 0]}]}",
                      "vehicle.footprint.0.offset.0", "finite"},
        BrokenVehicle{"short_offset", "vehicle: {footprint: [{radius: 1, offset: [1]}]}",
                      "vehicle.footprint.0.offset", "2 "},
        BrokenVehicle{"unknown_key", "vehicle: {footprint: [{radius: 1, ofset: [1, 0]}]}",
                      "vehicle.footprint.0.ofset", "offset"},
        BrokenVehicle{"offset_without_a_heading",
                      "vehicle: {footprint: [{radius: 1, offset: [1, 0]}]}\n"
                      "safe_set: {obstacles: [{x: [5, 6]}]}",
                      "vehicle.footprint.0.offset", "no heading", "point_mass"},
        BrokenVehicle{"no_file",
                      "vehicle: {footprint: from_mjcf}\nplant: {kind: analytic, mjcf: "
                      "\"\"}",
                      "vehicle.footprint", "point or discs"},
        BrokenVehicle{"discs_on_a_rail", "vehicle: {footprint: [{radius: 1}]}", "vehicle.footprint",
                      "no position", "double_integrator"},
        BrokenVehicle{"a_vehicle_on_a_rail", "vehicle: {footprint: from_mjcf}", "vehicle.footprint",
                      "no position", "double_integrator"}),
    [](const auto& tested) { return tested.param.name; });

TEST(Vehicle, of_a_file_without_a_mapping_is_refused_where_it_is_only_drawn) {
  const TemporaryFolder folder;
  const std::string file = vehicle_file(folder, "");
  const std::string text =
      "name: a\nmodel: {system: dubins}\ninitial_state: {mean: [0, 0, 0]}\ntarget: {state: [5, 0, "
      "0]}\nplant: {kind: analytic, mjcf: " +
      file + "}\n";
  const InputError::Where where = refusal_of(text);
  EXPECT_EQ(where.key, "vehicle.footprint");
  EXPECT_THAT(where.expected, HasSubstr("point, discs"));
  EXPECT_TRUE(parse_scenario(text + "vehicle: {footprint: point}\n").safe_set.body.is_point());
}

}  // namespace vehicle_footprint_test
}  // namespace qsmpc::harness
