#include <algorithm>
#include <cmath>
#include <fstream>
#include <numbers>
#include <ostream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

#include "controller/regions/unsafe_set.hpp"
#include "harness/errors.hpp"
#include "harness/mujoco/mujoco_model.hpp"
#include "harness/plant/mujoco/mujoco_plant.hpp"
#include "harness/plant/mujoco/solid_map.hpp"
#include "harness/plant/plant_registry.hpp"
#include "harness/scenario/scenario_file.hpp"
#include "harness/scenario/vehicle_footprint.hpp"
#include "models/constants.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/unit/plant/plant_fixture.hpp"
#include "tests/unit/plant/shipped_plants.hpp"

namespace qsmpc::harness {
namespace solid_plant_test {

/// A vehicle, and how it is driven straight ahead.
struct DrivenVehicle {
  std::string name;
  std::string system;
  std::string mjcf;
  double speed;     // m/s, at the start
  bool is_stopped;  // whether a block stops it
};

std::ostream& operator<<(std::ostream& out, const DrivenVehicle& vehicle) {
  return out << vehicle.mjcf;
}

controller::SafeSet map_with(Eigen::Index dim, const std::vector<Eigen::Vector4d>& blocks) {
  controller::SafeSet map = controller::unbounded_safe_set(dim);
  for (const Eigen::Vector4d& block : blocks) {
    controller::Box box = map.bounds;
    box.lower.head<2>() = Eigen::Vector2d(block[0], block[2]);
    box.upper.head<2>() = Eigen::Vector2d(block[1], block[3]);
    map.obstacles.push_back(box);
  }
  return map;
}

class SolidVehicle : public ::testing::TestWithParam<DrivenVehicle> {
 protected:
  static constexpr double kPeriod = 0.1;  // s

  SolidVehicle() : setup_(shipped_setup(GetParam().system, GetParam().mjcf)) {
    dim_ = std::ssize(setup_.system.states);
    start_ = Eigen::VectorXd::Zero(dim_);
    if (dim_ > 3) start_[3] = GetParam().speed;
    input_ = Eigen::VectorXd::Zero(std::ssize(setup_.system.inputs));
    disturbance_ = Eigen::VectorXd::Zero(dim_);
    for (const controller::Disc& disc : vehicle_footprint(
             setup_.mjcf, {}, {.description = setup_.system, .parameters = setup_.parameters})) {
      front_ = std::max(front_, disc.offset.x() + disc.radius);
    }
  }

  /// Drives for 3 s from `start_` over the map.
  std::vector<PlantStep> drive(const controller::SafeSet& map) {
    setup_.solid = map;
    const auto plant = make_mujoco_plant(setup_);
    plant->reset(start_);
    std::vector<PlantStep> steps;
    for (int k = 0; k < 30; ++k) {
      steps.push_back(plant->advance(input_, disturbance_));
      EXPECT_FALSE(steps.back().fault.has_value()) << *steps.back().fault;
    }
    return steps;
  }

  MujocoPlantSetup setup_;
  Eigen::Index dim_ = 0;
  Eigen::VectorXd start_;
  Eigen::VectorXd input_;
  Eigen::VectorXd disturbance_;
  double front_ = 0.0;  // m, how far the footprint extends ahead
};

// The footprint reaches the block before the vehicle does, by at most its excess: 15 % of the
// width, plus the discs' radius ahead.
TEST_P(SolidVehicle, touches_a_block_soon_after_its_footprint_does) {
  const double block = front_ + 1.0;
  const auto steps = drive(map_with(dim_, {{block, block + 1.0, -2.0, 2.0}}));
  const double allowance = 0.6 * front_;
  double touching = kNotANumber;
  double farthest = 0.0;
  for (std::size_t k = 0; k < steps.size(); ++k) {
    const PlantStep& step = steps[k];
    farthest = std::max(farthest, step.state[0]);
    if (!std::isnan(touching) || !(step.contact.force > 0.0)) continue;
    const double first = step.contact.time - kPeriod * static_cast<double>(k);
    const double share = first / kPeriod * static_cast<double>(step.between.cols());
    touching = step.between(0, std::min(std::lround(share), step.between.cols() - 1));
  }
  ASSERT_FALSE(std::isnan(touching));
  EXPECT_GE(touching + front_, block - 1e-3);
  EXPECT_LE(touching + front_, block + allowance);
  if (GetParam().is_stopped) {
    EXPECT_LE(farthest + front_, block + allowance + 0.2);
  }
}

TEST_P(SolidVehicle, that_touches_nothing_has_no_contact_and_moves_as_if_nothing_stood_there) {
  const auto steps = drive(map_with(dim_, {{front_, front_ + 30.0, 3.0, 5.0}}));
  setup_.solid.reset();
  const auto plant = make_mujoco_plant(setup_);
  plant->reset(start_);
  for (const PlantStep& step : steps) {
    EXPECT_EQ(step.contact.force, 0.0);
    EXPECT_TRUE(std::isnan(step.contact.time));
    const PlantStep plain = plant->advance(input_, disturbance_);
    EXPECT_TRUE(std::isnan(plain.contact.force));
    EXPECT_LT((step.state - plain.state).norm(), 1e-9);
  }
}

TEST_P(SolidVehicle, is_stopped_by_a_bound_and_comes_out_of_a_block_that_it_was_put_into) {
  controller::SafeSet map = map_with(dim_, {});
  map.bounds.upper[0] = front_ + 0.5;
  double farthest = 0.0;
  for (const PlantStep& step : drive(map)) farthest = std::max(farthest, step.state[0]);
  if (GetParam().is_stopped) {
    EXPECT_LT(farthest, 0.5 + 0.6 * front_ + 0.2);
  }

  setup_.solid = map_with(dim_, {{front_, front_ + 2.0, -2.0, 2.0}});
  const auto plant = make_mujoco_plant(setup_);
  plant->reset(start_);
  disturbance_[0] = 0.3;  // m, into the block
  const PlantStep kicked = plant->advance(input_, disturbance_);
  EXPECT_GT(kicked.contact.force, 0.0);
  EXPECT_LE(kicked.contact.time, kPeriod + 1e-9);
  disturbance_[0] = 0.0;
  for (int k = 0; k < 20; ++k) {
    const PlantStep step = plant->advance(input_, disturbance_);
    ASSERT_FALSE(step.fault.has_value()) << *step.fault;
  }
}

INSTANTIATE_TEST_SUITE_P(
    Shipped, SolidVehicle,
    ::testing::Values(DrivenVehicle{"dubins_car", "dubins", "dubins_car.xml", 1.5, true},
                      DrivenVehicle{"dubins_planar", "dubins", "dubins_planar.xml", 1.5, false},
                      DrivenVehicle{"bicycle_car", "bicycle", "bicycle_car.xml", 5.0, true},
                      DrivenVehicle{"bicycle_planar", "bicycle", "bicycle_planar.xml", 5.0, true}),
    [](const auto& tested) { return tested.param.name; });

/// A shape whose surface is at (`ahead`, 0), or within 1 cm of it, along the x axis.
struct MetShape {
  std::string name;
  controller::PlanarShape (*at)(double ahead);
};

std::ostream& operator<<(std::ostream& out, const MetShape& shape) { return out << shape.name; }

controller::PlanarShape disc_at(double ahead) {
  return controller::DiscShape{.centre = {ahead + 0.5, 0.0}, .radius = 0.5};
}

controller::PlanarShape ellipse_at(double ahead) {
  return controller::EllipseShape{
      .centre = {ahead + 0.4, 0.0}, .semi_axes = {1.2, 0.4}, .angle = 0.5 * std::numbers::pi};
}

controller::PlanarShape turned_box_at(double ahead) {
  return controller::TurnedBoxShape{
      .centre = {ahead + 1.0, 0.0}, .size = {2.0, 2.0}, .angle = 0.05};
}

controller::PlanarShape half_plane_at(double ahead) {
  return controller::HalfPlaneShape{.normal = {2.0, 0.2}, .offset = 2.0 * ahead};
}

/// An L-shaped polygon; the car drives into its inner corner.
controller::PlanarShape corner_at(double ahead) {
  Eigen::Matrix2Xd corners(2, 6);
  corners << -1.0, 1.0, 1.0, 0.0, 0.0, -1.0,  //
      -1.5, -1.5, 1.5, 1.5, -0.6, -0.6;
  corners.row(0).array() += ahead;
  return controller::PolygonShape{corners};
}

controller::PlanarShape triangle_at(double ahead) {
  Eigen::Matrix2Xd corners(2, 3);
  corners << -0.05, 0.05, 1.0, 0.6, -0.6, 0.1;
  corners.row(0).array() += ahead;
  return controller::PolygonShape{corners};
}

class SolidShape : public ::testing::TestWithParam<MetShape> {
 protected:
  /// The car's state at first contact with the obstacle, and the smallest clearance of its
  /// footprint within 3 s.
  struct Meeting {
    Eigen::VectorXd state;
    double least = kInfinity;
  };

  controller::SafeSet map_of(const controller::Obstacle& obstacle) const {
    controller::SafeSet map = controller::unbounded_safe_set(3);
    map.obstacles.push_back(obstacle);
    map.body = {
        .discs = vehicle_footprint(setup_.mjcf, {},
                                   {.description = setup_.system, .parameters = setup_.parameters}),
        .x = 0,
        .y = 1,
        .heading = 2};
    return map;
  }

  /// Drives straight ahead from the origin.
  Meeting meet(const controller::Obstacle& obstacle) {
    Meeting meeting;
    setup_.solid = map_of(obstacle);
    const controller::UnsafeSet unsafe(*setup_.solid);
    const auto car = make_mujoco_plant(setup_);
    car->reset(pose(0.0, 0.0, 0.0));
    for (int k = 0; k < 30; ++k) {
      const PlantStep step = car->advance(yaw_rate(0.0), no_disturbance());
      EXPECT_FALSE(step.fault.has_value()) << *step.fault;
      for (const auto& state : step.between.colwise()) {
        meeting.least = std::min(meeting.least, controller::clearance(state, unsafe));
      }
      if (meeting.state.size() > 0 || !(step.contact.force > 0.0)) continue;
      const double share = (step.contact.time - kControlPeriod * k) / kControlPeriod;
      const auto steps = static_cast<double>(step.between.cols());
      meeting.state =
          step.between.col(std::min(std::lround(share * steps), step.between.cols() - 1));
    }
    return meeting;
  }

  MujocoPlantSetup setup_ = car_setup();
};

// The footprint's discs, which cover the hull, extend 0.086 m beyond its nose.
TEST_P(SolidShape, stops_a_car_where_a_block_would) {
  constexpr double kAhead = 1.6;  // m
  const Meeting block = meet(map_with(3, {{kAhead, kAhead + 1.0, -2.0, 2.0}}).obstacles[0]);
  const controller::Obstacle shape = GetParam().at(kAhead);
  const Meeting met = meet(shape);
  ASSERT_EQ(block.state.size(), 3);
  ASSERT_EQ(met.state.size(), 3) << "no contact";
  const double clearance = controller::clearance(met.state, map_of(shape));
  EXPECT_LT(clearance, 0.0);
  EXPECT_GT(clearance, -0.1);
  EXPECT_NEAR(met.state[0], block.state[0], 0.02);  // not all faces are perpendicular to the path
  EXPECT_GT(met.least, -0.2) << "it drives through";
}

TEST_P(SolidShape, leaves_a_car_alone_that_drives_past) {
  setup_.solid = map_of(GetParam().at(1.6));
  const auto car = make_mujoco_plant(setup_);
  car->reset(pose(0.0, -5.0, -0.5 * std::numbers::pi));
  for (int k = 0; k < 10; ++k) {
    const PlantStep step = car->advance(yaw_rate(0.0), no_disturbance());
    ASSERT_FALSE(step.fault.has_value()) << *step.fault;
    EXPECT_EQ(step.contact.force, 0.0);
  }
}

INSTANTIATE_TEST_SUITE_P(
    Shapes, SolidShape,
    ::testing::Values(MetShape{"disc", disc_at}, MetShape{"ellipse", ellipse_at},
                      MetShape{"turned_box", turned_box_at}, MetShape{"half_plane", half_plane_at},
                      MetShape{"corner", corner_at}, MetShape{"triangle", triangle_at}),
    [](const auto& tested) { return tested.param.name; });

// A disc that moves onto a standing car pushes it along; one that passes beside it does not.
TEST(SolidPlant, moves_what_moves) {
  MujocoPlantSetup setup = car_setup();
  controller::SafeSet map = controller::unbounded_safe_set(3);
  map.body = {.discs = {}, .x = 0, .y = 1, .heading = 2};
  controller::Obstacle bar(controller::TurnedBoxShape{.centre = {0.0, 3.0}, .size = {0.3, 2.0}});
  bar.motion.emplace();
  map.obstacles = {corner_at(50.0), bar};
  setup.solid = map;
  const auto plant = make_mujoco_plant(setup);
  const auto pushed = [&](const Eigen::Vector3d& end) {
    plant->reset(pose(0.0, 0.0, 0.0));
    double force = 0.0;
    for (int k = 0; k < 5; ++k) {
      plant->move_obstacles(0.2 * k * end, 0.2 * (k + 1) * end);
      const PlantStep step = plant->advance(yaw_rate(0.0), no_disturbance());
      EXPECT_FALSE(step.fault.has_value()) << *step.fault;
      force = std::fmax(force, step.contact.force);
    }
    return force;
  };
  EXPECT_EQ(pushed({0.0, 0.0, 0.0}), 0.0);
  EXPECT_GT(pushed({0.6, -2.2, 0.0}), 0.0);
  // Sideways, it is too far away.
  EXPECT_EQ(pushed({0.6, -1.7, 0.5 * std::numbers::pi}), 0.0);
  EXPECT_GT(pushed({0.6, -1.9, 0.0}), 0.0);
}

TEST(SolidPlant, has_a_prism_for_each_convex_part_where_the_coordinates_are_large) {
  constexpr double kEast = 500'000.0;  // m, as in surveyors' maps
  controller::SafeSet map = controller::unbounded_safe_set(3);
  map.body = {.discs = {}, .x = 0, .y = 1};
  map.obstacles.emplace_back(corner_at(kEast));
  const MujocoModelPtr plain = load_mujoco_model(kCarFile);
  const MujocoModelPtr model = load_with_solids(kCarFile, map, car_setup().system);
  ASSERT_EQ(model->ngeom, plain->ngeom + 2);
  ASSERT_EQ(model->nmesh, plain->nmesh + 2);
  // The corners of both parts: mesh, geom, and MuJoCo's rotation and translation of the mesh.
  Eigen::Vector2d lowest = Eigen::Vector2d::Constant(1e9);
  Eigen::Vector2d highest = -lowest;
  for (int geom = 0; geom < model->ngeom; ++geom) {
    if (!std::string(model->names + model->name_geomadr[geom]).starts_with("qsmpc_solid_"))
      continue;
    const int mesh = model->geom_dataid[geom];
    for (int i = 0; i < model->mesh_vertnum[mesh]; ++i) {
      const float* vertex = model->mesh_vert + 3 * (model->mesh_vertadr[mesh] + i);
      double from[3] = {0.0, 0.0, 0.0};
      mju_f2n(from, vertex, 3);
      double to[3] = {0.0, 0.0, 0.0};
      mju_rotVecQuat(to, from, model->geom_quat + 4 * geom);
      const Eigen::Vector2d at(to[0] + model->geom_pos[3 * geom],
                               to[1] + model->geom_pos[3 * geom + 1]);
      lowest = lowest.cwiseMin(at);
      highest = highest.cwiseMax(at);
    }
  }
  EXPECT_NEAR(lowest.x(), kEast - 1.0, 1e-4);
  EXPECT_NEAR(lowest.y(), -1.5, 1e-4);
  EXPECT_NEAR(highest.x(), kEast + 1.0, 1e-4);
  EXPECT_NEAR(highest.y(), 1.5, 1e-4);
}

TEST(SolidPlant, finds_what_a_model_includes_beside_it) {
  const testing::TemporaryFolder folder;
  std::ofstream(folder / "part.xml")
      << R"(<mujocoinclude><geom type="box" size="0.4 0.1 0.1" mass="1"/></mujocoinclude>)";
  std::ofstream(folder / "own.xml") << R"(<mujoco><option gravity="0 0 0"/>
    <default><geom contype="0" conaffinity="0" friction="9"/></default>
    <worldbody><body name="base"><freejoint/><include file="part.xml"/></body></worldbody>
    </mujoco>)";
  const MujocoModelPtr model = load_mujoco_model_with(
      folder / "own.xml", "<worldbody><geom name=\"more\" size=\"1\"/></worldbody>\n");
  EXPECT_NE(model, nullptr);
}

TEST(SolidPlant, pulls_the_vehicle_as_if_nothing_stood_in_its_way) {
  MujocoPlantSetup setup = car_setup();
  setup.force_covariance = Eigen::Vector3d(0.01, 0.01, 0.001).asDiagonal();
  setup.solid = map_with(3, {{0.7, 1.7, -1.0, 1.0}});
  const auto plant = make_mujoco_plant(setup);
  plant->reset(pose(0.0, 0.0, 0.0));
  for (int k = 0; k < 5; ++k) {
    const PlantStep step = plant->advance(yaw_rate(0.0), pose(0.1, 0.0, 0.0));
    ASSERT_FALSE(step.fault.has_value()) << *step.fault;
    if (step.contact.force > 0.0) return;
  }
  FAIL() << "no contact";
}

TEST(SolidPlant, is_refused_where_there_is_no_body_to_stop) {
  const std::string text =
      "name: a\nmodel: {system: SYSTEM}\ninitial_state: {mean: MEAN}\ntarget: {state: MEAN}\n"
      "plant: {kind: KIND, solid: true}\n";
  const auto refusal = [&](std::string system, std::string mean, std::string kind) {
    std::string filled = text;
    for (const auto& [from, to] : {std::pair{std::string("SYSTEM"), system},
                                   {"MEAN", mean},
                                   {"MEAN", mean},
                                   {"KIND", kind}}) {
      filled.replace(filled.find(from), from.size(), to);
    }
    try {
      (void)parse_scenario(filled);
    } catch (const InputError& error) {
      return error.where();
    }
    return InputError::Where{};
  };
  const auto analytic = refusal("dubins", "[0, 0, 0]", "analytic");
  EXPECT_EQ(analytic.key, "plant.solid");
  EXPECT_THAT(analytic.expected, ::testing::HasSubstr("plant.kind: mujoco"));
  const auto rail = refusal("double_integrator", "[0, 0]", "mujoco");
  EXPECT_EQ(rail.key, "plant.solid");
  EXPECT_THAT(rail.expected, ::testing::HasSubstr("no position"));
  EXPECT_EQ(refusal("dubins", "[0, 0, 0]", "mujoco").key, "");
  Scenario scenario = parse_scenario(
      "name: a\nmodel: {system: dubins}\ninitial_state: {mean: [0, "
      "0, 0]}\ntarget: {state: [5, 0, 0]}\n");
  scenario.plant.kind = "analytic";
  scenario.plant.solid = true;
  EXPECT_THROW((void)make_plant(scenario), InputError);
}

TEST(PlantSteps, have_the_states_at_the_simulators_steps) {
  const auto car = make_car();
  car->reset(pose(0.0, 0.0, 0.0));
  const PlantStep step = car->advance(yaw_rate(0.5), pose(0.25, 0.0, 0.0));
  ASSERT_EQ(step.between.cols(), 50);  // of 2 ms each
  ASSERT_EQ(step.between.rows(), 3);
  for (Eigen::Index k = 1; k < 50; ++k) {
    EXPECT_NEAR(step.between(0, k) - step.between(0, k - 1), 0.003, 0.0003);
  }
  // The last one is the end of the period, before the disturbance.
  EXPECT_NEAR(step.state[0] - step.between(0, 49), 0.25, 1e-6);
}

}  // namespace solid_plant_test
}  // namespace qsmpc::harness
