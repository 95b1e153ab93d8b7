#include "harness/mujoco/vehicle_shapes.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "harness/errors.hpp"
#include "harness/scenario/scenario_file.hpp"
#include "tests/support/example_trace.hpp"
#include "tests/support/temporary_folder.hpp"

namespace qsmpc::harness {
namespace vehicle_shapes_test {

constexpr double kRounding = 1e-12;

std::string model_file(const testing::TemporaryFolder& folder, const std::string& world,
                       const std::string& asset = "") {
  return folder.file("vehicle.xml", "<mujoco><asset>" + asset + "</asset><worldbody>" + world +
                                        "</worldbody></mujoco>");
}

std::string shipped(const std::string& mjcf) {
  std::string text = testing::example_scenario({});
  const std::string none = "{kind: analytic}";
  text.replace(text.find(none), none.size(), "{kind: analytic, mjcf: " + mjcf + "}");
  return parse_scenario(text).plant.mjcf;
}

/// x, y and heading; the wheels' own joints at rest.
std::vector<double> car_at(const VehicleShapes& car, double x, double y, double heading) {
  std::vector<double> qpos(car.coordinate_count(), 0.0);
  const std::vector<double> root{
      x, y, 0.06, std::cos(0.5 * heading), 0.0, 0.0, std::sin(0.5 * heading)};
  std::ranges::copy(root, qpos.begin());
  return qpos;
}

/// The shape's placement in the world.
Placement in_world(const VehicleShape& shape, const std::vector<Placement>& parts) {
  if (shape.part < 0) return shape.place;
  const Placement& part = parts[static_cast<std::size_t>(shape.part)];
  return {part.position + part.rotation * shape.place.position,
          part.rotation * shape.place.rotation};
}

std::vector<VehicleShape> of_kind(const VehicleShapes& vehicle, ShapeKind kind) {
  std::vector<VehicleShape> found;
  std::ranges::copy_if(vehicle.shapes(), std::back_inserter(found),
                       [kind](const VehicleShape& shape) { return shape.kind == kind; });
  return found;
}

TEST(VehicleShapes, of_a_car_are_where_its_coordinates_say) {
  VehicleShapes car(shipped("dubins_car.xml"));
  // A body and four wheels.
  ASSERT_EQ(car.part_count(), 5U);
  const auto parts = car.parts(car_at(car, 3.0, 4.0, 0.5 * std::numbers::pi));
  // Heading along y: the front axle is 0.3 m ahead, the left wheels 0.11 m towards smaller x.
  std::vector<Eigen::Vector3d> expected{
      {2.89, 4.0, 0.06}, {3.11, 4.0, 0.06}, {2.89, 4.3, 0.06}, {3.11, 4.3, 0.06}};
  int tyres = 0;
  for (const VehicleShape& shape : of_kind(car, ShapeKind::kCylinder)) {
    if (std::abs(shape.size[0] - 0.06) > kRounding) continue;
    ++tyres;
    const Placement place = in_world(shape, parts);
    const bool known = std::ranges::any_of(expected, [&](const Eigen::Vector3d& wheel) {
      return (wheel - place.position).norm() < kRounding;
    });
    EXPECT_TRUE(known) << place.position.transpose();
    // Their axis, the z axis of a cylinder, points across the vehicle.
    EXPECT_NEAR(std::abs((place.rotation * Eigen::Vector3d::UnitZ()).x()), 1.0, kRounding);
  }
  EXPECT_EQ(tyres, 4);
}

TEST(VehicleShapes, are_visible_ones_in_the_colours_of_the_file) {
  const VehicleShapes car(shipped("dubins_car.xml"));
  for (const VehicleShape& shape : car.shapes()) {
    // The ellipsoids that touch the ground are hidden, and so is the chassis box.
    EXPECT_FALSE(shape.kind == ShapeKind::kEllipsoid && shape.size[0] > 0.05);
    EXPECT_FALSE(shape.kind == ShapeKind::kBox && std::abs(shape.size[1] - 0.09) < kRounding);
  }
  // MuJoCo stores colours in single precision.
  const std::array<double, 4> paint{static_cast<double>(0.95F), static_cast<double>(0.42F),
                                    static_cast<double>(0.08F), 1.0};
  const std::vector<VehicleShape> hull = of_kind(car, ShapeKind::kMesh);
  ASSERT_EQ(hull.size(), 5U);
  EXPECT_EQ(std::ranges::count(hull, paint, &VehicleShape::rgba), 4);
}

TEST(VehicleShapes, at_the_origin_head_along_x) {
  VehicleShapes car(shipped("dubins_car.xml"));
  const auto expected = car.parts(car_at(car, 0.0, 0.0, 0.0));
  const auto parts = car.parts_at_origin();
  ASSERT_EQ(parts.size(), expected.size());
  for (std::size_t i = 0; i < parts.size(); ++i) {
    EXPECT_LT((parts[i].position - expected[i].position).norm(), kRounding);
    EXPECT_LT(parts[i].rotation.angularDistance(expected[i].rotation), 1e-7);
  }
}

TEST(VehicleShapes, of_bodies_without_a_joint_between_them_are_one_part) {
  const testing::TemporaryFolder folder;
  VehicleShapes vehicle(
      model_file(folder,
                 "<geom type='box' size='1 1 1' pos='9 0 0'/>"
                 "<body pos='1 2 3'><joint type='slide' axis='1 0 0'/><geom size='.1'/>"
                 "<body pos='0 0 1' euler='0 0 90'><geom type='capsule' size='.1 .2' pos='1 0 0'/>"
                 "</body></body>"));
  ASSERT_EQ(vehicle.part_count(), 1U);
  ASSERT_EQ(vehicle.shapes().size(), 3U);
  const auto parts = vehicle.parts(std::vector{0.5});
  EXPECT_EQ(vehicle.shapes()[0].part, VehicleShape::kWorld);
  EXPECT_LT((in_world(vehicle.shapes()[0], parts).position - Eigen::Vector3d(9, 0, 0)).norm(),
            kRounding);
  EXPECT_LT((in_world(vehicle.shapes()[1], parts).position - Eigen::Vector3d(1.5, 2, 3)).norm(),
            kRounding);
  EXPECT_LT((in_world(vehicle.shapes()[2], parts).position - Eigen::Vector3d(1.5, 3, 4)).norm(),
            kRounding);
}

TEST(VehicleShapes, with_too_many_triangles_are_boxes) {
  const testing::TemporaryFolder folder;
  const std::string fields =
      "<hfield name='small' nrow='3' ncol='4' size='2 1 .5 .1'/>"
      "<hfield name='large' nrow='200' ncol='200' size='3 2 .5 .1'/>";
  const VehicleShapes vehicle(model_file(
      folder, "<geom type='hfield' hfield='small'/><geom type='hfield' hfield='large'/>", fields));
  EXPECT_EQ(vehicle.boxed(), 1);
  ASSERT_EQ(vehicle.meshes().size(), 1U);
  EXPECT_EQ(vehicle.meshes()[0].vertices.size(), 3U * 12U);
  EXPECT_EQ(vehicle.meshes()[0].triangles.size(), 3U * 2U * 2U * 3U);
  ASSERT_EQ(vehicle.shapes().size(), 2U);
  EXPECT_EQ(vehicle.shapes()[0].kind, ShapeKind::kMesh);
  EXPECT_EQ(vehicle.shapes()[1].kind, ShapeKind::kBox);
  EXPECT_EQ(vehicle.shapes()[1].size[0], 3.0);
  EXPECT_EQ(vehicle.shapes()[1].size[1], 2.0);
}

TEST(VehicleShapes, are_nowhere_at_coordinates_of_another_model) {
  VehicleShapes car(shipped("dubins_car.xml"));
  std::vector<double> qpos = car_at(car, 0.0, 0.0, 0.0);
  qpos[0] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW((void)car.parts(qpos), std::invalid_argument);
  EXPECT_THROW((void)car.parts(std::vector{1.0, 2.0}), std::invalid_argument);
  EXPECT_THROW(VehicleShapes("no such file.xml"), InputError);
}

}  // namespace vehicle_shapes_test
}  // namespace qsmpc::harness
