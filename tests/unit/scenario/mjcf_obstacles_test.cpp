// Obstacles from the geoms of the plant's MuJoCo XML file.
#include <cmath>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "harness/mujoco/ground_geoms.hpp"
#include "harness/mujoco/mujoco_model.hpp"
#include "tests/unit/scenario/scenario_fixture.hpp"
#include "tests/unit/scenario/scenario_round_trip.hpp"

namespace qsmpc::harness {
namespace mjcf_obstacles_test {

using ::testing::HasSubstr;

constexpr double kRounding = 1e-9;
constexpr double kFloat = 1e-6;  // mesh vertices are stored as float

const std::string yard = R"(<mujoco>
  <asset><mesh name="wedge" vertex="0 0 0  1 0 0  0 1 0  0 0 1"/></asset>
  <worldbody>
    <geom name="ground" type="plane" size="0 0 1" group="3"/>
    <geom name="north" type="plane" size="5 1 1" pos="0 9 0" zaxis="0 -1 0"/>
    <geom name="slope" type="plane" size="5 1 1" zaxis="1 0 1"/>
    <body pos="7 4 0" euler="0 0 30">
      <geom name="crate" type="box" size="1 0.5 0.4" pos="0 0 0.4" group="3"/>
    </body>
    <geom name="leaning" type="box" size="1 1 1" pos="20 4 2" euler="0 45 0"/>
    <geom name="pillar" type="cylinder" size="0.5 1" pos="9 1 1" group="3"/>
    <geom name="log" type="cylinder" size="0.2 1" pos="9 5 0.2" zaxis="1 0 0"/>
    <geom name="ball" type="sphere" size="0.3" pos="7 7 0.3"/>
    <geom name="egg" type="ellipsoid" size="1 0.5 0.2" pos="10 7 1" euler="0 45 0"/>
    <geom name="pill" type="capsule" size="0.2 0.5" pos="12 3 0.2" zaxis="0 1 0"/>
    <geom name="wedge" type="mesh" mesh="wedge" pos="12 6 0"/>
    <geom name="sign" type="box" size="1 1 0.1" pos="14 0 2.5" group="3"/>
    <geom name="slab" type="box" size="1 1 0.1" pos="14 4 -0.1" group="3"/>
    <body name="car" pos="0 0 1">
      <freejoint/>
      <geom name="hull" type="box" size="0.1 0.1 0.1" group="3"/>
      <body><geom name="mast" type="box" size="0.1 0.1 0.1"/></body>
    </body>
    <body name="walker" mocap="true" pos="0 5 0"><geom name="legs" type="sphere" size="0.2"/></body>
  </worldbody>
</mujoco>
)";

// A scenario driven on the model itself, beside the yard.
struct Yard {
  explicit Yard(const std::string& obstacles)
      : mjcf(folder.file("yard.xml", yard)),
        scenario(folder.file("s.yaml",
                             "name: yard\nmodel: {system: dubins}\n"
                             "plant: {kind: analytic, mjcf: yard.xml}\n"
                             "vehicle: {footprint: point}\n"
                             "initial_state: {mean: [0, 0, 0]}\n"
                             "target: {state: [5, 0, 0]}\n"
                             "safe_set:\n  obstacles_from_mjcf:\n    " +
                                 obstacles + "\n")) {}

  [[nodiscard]] std::vector<controller::Obstacle> obstacles() const {
    const Scenario loaded = load_scenario(scenario);
    expect_round_trip(loaded);
    return loaded.safe_set.obstacles;
  }

  TemporaryFolder folder{};
  std::string mjcf;
  std::string scenario;
};

GroundGeom geom_called(const std::string& name) {
  const TemporaryFolder folder;
  const MujocoModelPtr model = load_mujoco_model(folder.file("yard.xml", yard));
  for (GroundGeom& geom : ground_geoms(*model)) {
    if (geom.name == name) return std::move(geom);
  }
  ADD_FAILURE() << name;
  return {};
}

Eigen::Matrix2Xd polygon_of(const std::string& name) {
  const GroundGeom geom = geom_called(name);
  return std::get<controller::PolygonShape>(*geom.shape).corners;
}

TEST(GroundGeoms, of_upright_bodies_are_exact) {
  const auto crate = std::get<controller::TurnedBoxShape>(*geom_called("crate").shape);
  EXPECT_TRUE(crate.centre.isApprox(Eigen::Vector2d(7, 4), kRounding));
  // The order of its axes is unspecified.
  const bool swapped = crate.size.x() < crate.size.y();
  EXPECT_NEAR(crate.size.maxCoeff(), 2.0, kRounding);
  EXPECT_NEAR(crate.size.minCoeff(), 1.0, kRounding);
  const double along = crate.angle - (swapped ? std::numbers::pi / 2.0 : 0.0);
  EXPECT_NEAR(std::abs(std::sin(along - std::numbers::pi / 6.0)), 0.0, kRounding);
  const auto pillar = std::get<controller::DiscShape>(*geom_called("pillar").shape);
  EXPECT_TRUE(pillar.centre.isApprox(Eigen::Vector2d(9, 1), kRounding));
  EXPECT_NEAR(pillar.radius, 0.5, kRounding);
  const auto ball = std::get<controller::DiscShape>(*geom_called("ball").shape);
  EXPECT_NEAR(ball.radius, 0.3, kRounding);
}

TEST(GroundGeoms, of_a_vertical_plane_are_what_is_behind_it) {
  const auto north = std::get<controller::HalfPlaneShape>(*geom_called("north").shape);
  EXPECT_TRUE(north.normal.isApprox(Eigen::Vector2d(0, 1), kRounding));
  EXPECT_NEAR(north.offset, 9.0, kRounding);
}

TEST(GroundGeoms, of_a_tilted_ellipsoid_are_an_exact_ellipse) {
  const auto egg = std::get<controller::EllipseShape>(*geom_called("egg").shape);
  EXPECT_NEAR(egg.semi_axes[0], std::sqrt(0.5 * (1.0 + 0.2 * 0.2)), kRounding);
  EXPECT_NEAR(egg.semi_axes[1], 0.5, kRounding);
  EXPECT_NEAR(std::sin(egg.angle), 0.0, kRounding);
}

// Extents of the shadow along x and y, and the tolerance above them.
void expect_extent(const Eigen::Matrix2Xd& corners, const Eigen::Vector2d& lower,
                   const Eigen::Vector2d& upper, double beyond) {
  const Eigen::Vector2d least = corners.rowwise().minCoeff();
  const Eigen::Vector2d most = corners.rowwise().maxCoeff();
  EXPECT_TRUE((least.array() <= lower.array() + kFloat).all()) << least.transpose();
  EXPECT_TRUE((least.array() >= lower.array() - beyond).all()) << least.transpose();
  EXPECT_TRUE((most.array() >= upper.array() - kFloat).all()) << most.transpose();
  EXPECT_TRUE((most.array() <= upper.array() + beyond).all()) << most.transpose();
  EXPECT_EQ(controller::why_no_polygon(corners), "");
}

TEST(GroundGeoms, of_leaning_bodies_are_polygons_about_them) {
  const double half = std::numbers::sqrt2;
  const Eigen::Matrix2Xd leaning = polygon_of("leaning");
  EXPECT_LE(leaning.cols(), 6);
  expect_extent(leaning, {20 - half, 3}, {20 + half, 5}, kFloat);
  constexpr double kOfSides = 1e-3;  // for a size of 1 m, with 96 sides
  const Eigen::Matrix2Xd log = polygon_of("log");
  expect_extent(log, {8, 4.8}, {10, 5.2}, kOfSides);
  const Eigen::Matrix2Xd pill = polygon_of("pill");
  EXPECT_LE(pill.cols(), kProjectionSides);
  expect_extent(pill, {11.8, 2.3}, {12.2, 3.7}, kOfSides);
  const Eigen::Matrix2Xd wedge = polygon_of("wedge");
  EXPECT_LE(wedge.cols(), 4) << "its tip may be beside a corner by rounding";
  expect_extent(wedge, {12, 6}, {13, 7}, kFloat);
}

TEST(GroundGeoms, of_a_capsule_are_outside_of_its_round_ends) {
  const Eigen::Matrix2Xd pill = polygon_of("pill");
  const controller::PlanarShape shape = controller::PolygonShape{.corners = pill};
  const controller::ConvexPart part = controller::convex_parts(shape).front();
  for (int k = 0; k < 1000; ++k) {
    const double angle = 2.0 * std::numbers::pi * k / 1000.0;
    const Eigen::Vector2d on_end(12.0 + 0.2 * std::cos(angle),
                                 3.0 + (std::sin(angle) > 0 ? 0.5 : -0.5) + 0.2 * std::sin(angle));
    EXPECT_LE((part.normals.transpose() * on_end - part.offsets).maxCoeff(), 0.0) << angle;
  }
}

TEST(MjcfObstacles, are_geoms_by_their_names) {
  const auto obstacles = Yard("geoms: [crate, north, pill]").obstacles();
  ASSERT_EQ(obstacles.size(), 3U);
  EXPECT_TRUE(std::holds_alternative<controller::TurnedBoxShape>(*obstacles[0].shape()));
  EXPECT_TRUE(std::holds_alternative<controller::HalfPlaneShape>(*obstacles[1].shape()));
  EXPECT_TRUE(std::holds_alternative<controller::PolygonShape>(*obstacles[2].shape()));
}

TEST(MjcfObstacles, of_a_group_are_those_that_stand_still_above_the_ground) {
  EXPECT_EQ(Yard("group: 3").obstacles().size(), 3U) << "crate, pillar, sign";
  EXPECT_EQ(Yard("{group: 3, height: 2}").obstacles().size(), 2U) << "the sign is higher";
}

TEST(MjcfObstacles, are_in_the_resolved_scenario) {
  const Yard files("geoms: [pillar]");
  const std::string resolved = to_yaml(load_scenario(files.scenario));
  EXPECT_THAT(resolved, HasSubstr("- {disc: {centre: [9, 1], radius: 0.5}}"));
  EXPECT_THAT(resolved, ::testing::Not(HasSubstr("obstacles_from")));
}

struct BrokenChoice {
  std::string name;
  std::string choice;  ///< from line 9
  std::string key;     ///< after safe_set.obstacles_from_mjcf
  std::string found;
  std::string expected;
  int line = 9;
};

class BrokenMjcfObstacles : public ::testing::TestWithParam<BrokenChoice> {};

TEST_P(BrokenMjcfObstacles, are_refused_with_where_and_why) {
  const BrokenChoice& broken = GetParam();
  const Yard files(broken.choice);
  const auto problems = validate_scenario_file(files.scenario);
  ASSERT_EQ(problems.size(), 1U);
  EXPECT_EQ(problems[0].file, files.scenario);
  EXPECT_EQ(problems[0].line, broken.line);
  EXPECT_EQ(problems[0].key, "safe_set.obstacles_from_mjcf" + broken.key);
  EXPECT_THAT(problems[0].found, HasSubstr(broken.found));
  EXPECT_THAT(problems[0].expected, HasSubstr(broken.expected));
}

INSTANTIATE_TEST_SUITE_P(
    Choices, BrokenMjcfObstacles,
    ::testing::Values(
        BrokenChoice{"unknown_name", "geoms: [crate, piller]", ".geoms.1", "piller",
                     "pillar or pill (known: north, leaning, pillar"},
        BrokenChoice{"vehicle", "geoms: [hull]", ".geoms.0", "hull, which moves",
                     "fixed to the world"},
        BrokenChoice{"part_of_the_vehicle", "geoms: [mast]", ".geoms.0", "mast, which moves",
                     "fixed to the world"},
        BrokenChoice{"mocap_body", "geoms: [legs]", ".geoms.0", "legs, which moves",
                     "fixed to the world"},
        BrokenChoice{"ground", "geoms: [ground]", ".geoms.0", "ground, a level plane",
                     "vertical planes"},
        BrokenChoice{"slope", "geoms: [slope]", ".geoms.0", "slope, a tilted plane",
                     "vertical planes"},
        BrokenChoice{"too_high", "{geoms: [sign], height: 2}", ".geoms.0",
                     "sign, from 2.4 to 2.6 m high", "between the ground and 2 m"},
        BrokenChoice{"below_the_ground", "geoms: [slab]", ".geoms.0", "slab, from -0.2 to 0 m",
                     "between the ground and any height"},
        BrokenChoice{"twice", "geoms: [crate, crate]", ".geoms.1", "crate a second time", "once"},
        BrokenChoice{"group_with_a_slope", "group: 0", ".group", "slope, a tilted plane",
                     "vertical planes"},
        BrokenChoice{"empty_group", "group: 4", ".group", "no geom that stands in the way",
                     "a group with such geoms: 0, 3"},
        BrokenChoice{"no_such_group", "group: 6", ".group", "6", "from 0 to 5"},
        BrokenChoice{"no_name", "geoms: []", ".geoms", "an empty list", "at least one name"},
        BrokenChoice{"both", "{geoms: [crate], group: 3}", "", "both", "geoms, a list of names", 8},
        BrokenChoice{"neither", "{height: 2}", "", "neither", "geoms, a list of names", 8},
        BrokenChoice{"unknown_key", "{geom: [crate], group: 3}", ".geom", "an unknown key",
                     "geoms (known"}),
    [](const auto& tested) { return tested.param.name; });

TEST(MjcfObstacles, need_a_file) {
  const InputError::Where where =
      refusal_of(minimal_text, {"safe_set.obstacles_from_mjcf={group: 3}"});
  EXPECT_EQ(where.key, "safe_set.obstacles_from_mjcf");
  EXPECT_THAT(where.expected, HasSubstr("no plant.mjcf"));
}

}  // namespace mjcf_obstacles_test
}  // namespace qsmpc::harness
