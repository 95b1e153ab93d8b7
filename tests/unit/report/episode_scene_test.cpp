#include "harness/report/episode_scene.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "harness/mujoco/mujoco_model.hpp"
#include "harness/mujoco/vehicle_shapes.hpp"
#include "harness/report/episode_map.hpp"
#include "harness/report/episode_page.hpp"
#include "harness/scenario/scenario_file.hpp"
#include "tests/support/described_trace.hpp"
#include "tests/support/example_trace.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/unit/report/packed_data.hpp"
#include "tests/unit/report/page_checks.hpp"

namespace qsmpc::harness {
namespace episode_scene_test {

using testing::contains;
using testing::numbers_of;
using testing::occurrences;

constexpr std::size_t kPlace = 7;  // numbers per place
constexpr double kSinglePrecision = 1e-6;

/// A minimal vehicle that slides along x and y and turns: qpos is x, y, heading.
constexpr const char* kVehicle =
    "<mujoco><compiler angle='radian'/><worldbody><body pos='0 0 0.2'>"
    "<joint type='slide' axis='1 0 0'/><joint type='slide' axis='0 1 0'/>"
    "<joint type='hinge' axis='0 0 1'/>"
    "<geom type='box' size='.3 .2 .1' rgba='1 .5 0 1'/></body></worldbody></mujoco>";

/// The example with that vehicle and the motion of a MuJoCo plant: three samples per period, and
/// one more after the disturbance.
Trace driven_trace(const std::string& mjcf) {
  Trace trace = testing::example_trace();
  trace.scenario.plant.mjcf = mjcf;
  trace.motion.clear();
  const auto sample = [&](double time, const Eigen::VectorXd& state) {
    trace.motion.push_back({.time = time, .qpos = {state[0], state[1], state[2]}});
  };
  sample(0.0, trace.steps[0].state);
  for (std::size_t k = 0; k < trace.steps.size(); ++k) {
    const bool last = k + 1 == trace.steps.size();
    const Eigen::VectorXd after = last ? trace.final_state : trace.steps[k + 1].state;
    const Eigen::VectorXd before = after - trace.steps[k].disturbance;
    sample(trace.steps[k].time + 0.05, 0.5 * (trace.steps[k].state + before));
    sample(trace.steps[k].time + 0.1, before);
    sample(trace.steps[k].time + 0.1, after);
  }
  return trace;
}

EpisodeScene scene_of(const Trace& trace) {
  const EpisodeView view(trace);
  const PlaneMap ground = episode_maps(view)->ground;
  return episode_scene(view, &ground);
}

TEST(EpisodeScene, the_vehicle_is_where_the_trace_has_it_at_every_control_instant) {
  const testing::TemporaryFolder folder;
  const Trace trace = driven_trace(folder.file("vehicle.xml", kVehicle));
  const nlohmann::json scene = nlohmann::json::parse(scene_of(trace).data);
  ASSERT_EQ(scene["parts"], 1);
  const auto times = numbers_of<float>(scene["times"]);
  const auto places = numbers_of<float>(scene["places"]);
  ASSERT_EQ(times.size(), 2 * trace.steps.size() + 1);
  ASSERT_EQ(places.size(), kPlace * times.size());
  for (std::size_t k = 0; k <= trace.steps.size(); ++k) {
    const Eigen::VectorXd& state =
        k < trace.steps.size() ? trace.steps[k].state : trace.final_state;
    const float* place = &places[kPlace * 2 * k];
    EXPECT_NEAR(times[2 * k], 0.1 * static_cast<double>(k), kSinglePrecision);
    EXPECT_NEAR(place[0], state[0], kSinglePrecision);
    EXPECT_NEAR(place[1], state[1], kSinglePrecision);
    EXPECT_NEAR(place[2], 0.2, kSinglePrecision);
    EXPECT_NEAR(2.0F * std::atan2(place[5], place[6]), state[2], 1e-5);
  }
}

TEST(EpisodeScene, a_disturbance_moves_the_vehicle_over_all_of_its_period) {
  const testing::TemporaryFolder folder;
  const Trace trace = driven_trace(folder.file("vehicle.xml", kVehicle));
  const auto places = numbers_of<float>(nlohmann::json::parse(scene_of(trace).data)["places"]);
  for (std::size_t k = 0; k + 1 < trace.steps.size(); ++k) {
    // Half of the motion, and half of the jump.
    const Eigen::VectorXd middle = 0.5 * (trace.steps[k].state + trace.steps[k + 1].state);
    EXPECT_NEAR(places[kPlace * (2 * k + 1)], middle[0], kSinglePrecision);
    EXPECT_NEAR(places[kPlace * (2 * k + 1) + 1], middle[1], kSinglePrecision);
  }
}

TEST(EpisodeScene, holds_the_shapes_and_the_ground) {
  const testing::TemporaryFolder folder;
  const Trace trace = driven_trace(folder.file("vehicle.xml", kVehicle));
  const nlohmann::json scene = nlohmann::json::parse(scene_of(trace).data);
  ASSERT_EQ(scene["shapes"].size(), 1U);
  const nlohmann::json& shape = scene["shapes"][0];
  EXPECT_EQ(shape["kind"], "box");
  EXPECT_EQ(shape["part"], 0);
  EXPECT_EQ(shape["size"], nlohmann::json({0.3, 0.2, 0.1}));
  EXPECT_EQ(shape["rgba"], nlohmann::json({1.0, 0.5, 0.0, 1.0}));
  const nlohmann::json& ground = scene["ground"];
  EXPECT_EQ(ground["bounds"], nlohmann::json({-1.0, 12.0, -1.0, 12.0}));
  EXPECT_EQ(ground["obstacles"], nlohmann::json({{2.0, 4.0, 3.0, 5.0}, {6.0, 8.0, 5.0, 6.5}}));
  EXPECT_EQ(ground["targets"], nlohmann::json({{11.0, 9.0, 0.5}}));
}

TEST(EpisodeScene, holds_polygons_and_half_planes) {
  const testing::TemporaryFolder folder;
  Trace trace = driven_trace(folder.file("vehicle.xml", kVehicle));
  using controller::PlanarShape;
  std::vector<controller::Obstacle>& obstacles = trace.scenario.safe_set.obstacles;
  obstacles.emplace_back(PlanarShape(controller::PolygonShape{
      (Eigen::Matrix2Xd(2, 3) << 9.0, 10.0, 9.0, 1.0, 1.0, 2.5).finished()}));
  obstacles.emplace_back(PlanarShape(controller::DiscShape{.centre = {5, 9}, .radius = 0.75}));
  obstacles.emplace_back(PlanarShape(controller::HalfPlaneShape{.normal = {0, 1}, .offset = 11}));
  const nlohmann::json ground = nlohmann::json::parse(scene_of(trace).data)["ground"];
  EXPECT_EQ(ground["obstacles"].size(), 2U);
  ASSERT_EQ(ground["polygons"].size(), 2U);
  const std::vector<float> triangle{9.0F, 1.0F, 10.0F, 1.0F, 9.0F, 2.5F};
  EXPECT_EQ(numbers_of<float>(ground["polygons"][0]), triangle);
  const auto disc = numbers_of<float>(ground["polygons"][1]);
  ASSERT_GE(disc.size(), 64U);
  for (std::size_t i = 0; i < disc.size(); i += 2) {
    EXPECT_NEAR(std::hypot(disc[i] - 5.0F, disc[i + 1] - 9.0F), 0.75, 0.002);
  }
  EXPECT_EQ(ground["halfPlanes"], nlohmann::json({{0.0, 1.0, 11.0}}));
}

/// A rolling cart with a falling pole, by the model alone.
Trace cart_trace() {
  Trace trace;
  trace.scenario = load_scenario("cart_pole");
  for (int k = 0; k < 3; ++k) {
    StepRecord step;
    step.time = trace.scenario.time_step * k;
    step.state = Eigen::Vector4d(0.5 * k, 0.0, 0.1 * k, 0.0);
    step.input = Eigen::VectorXd::Zero(1);
    step.disturbance = Eigen::Vector4d::Zero();
    trace.steps.push_back(step);
  }
  trace.final_state = Eigen::Vector4d(1.5, 0.0, 0.3, 0.0);
  return testing::described(std::move(trace));
}

TEST(EpisodeScene, of_a_system_without_a_place_in_the_plane_has_its_joints_at_every_state) {
  const Trace trace = cart_trace();
  const EpisodeView view(trace);
  const nlohmann::json scene = nlohmann::json::parse(episode_scene(view, nullptr).data);
  EXPECT_FALSE(scene.contains("ground"));
  const auto times = numbers_of<float>(scene["times"]);
  const auto places = numbers_of<float>(scene["places"]);
  ASSERT_EQ(times.size(), 4U);
  EXPECT_NEAR(times.back(), 3.0 * trace.scenario.time_step, kSinglePrecision);
  const std::size_t parts = scene["parts"];
  ASSERT_EQ(places.size(), kPlace * parts * times.size());
  // Every part of the cart and its pole has moved by 1.5 m with the cart.
  bool moved = false;
  for (std::size_t part = 0; part < parts; ++part) {
    const float way = places[kPlace * (3 * parts + part)] - places[kPlace * part];
    moved = moved || std::abs(way - 1.5F) < 0.5F;
  }
  EXPECT_TRUE(moved);
}

TEST(EpisodeScene, of_a_system_on_a_rail_shows_the_shipped_vehicle_where_none_is_named) {
  Trace trace;
  trace.scenario = load_scenario("double_integrator");
  ASSERT_EQ(trace.scenario.plant.mjcf, "");
  StepRecord step;
  step.state = Eigen::Vector2d(0.0, 1.0);
  step.input = Eigen::VectorXd::Zero(1);
  step.disturbance = Eigen::Vector2d::Zero();
  trace.steps.push_back(step);
  trace.final_state = Eigen::Vector2d(0.1, 1.0);
  const Trace described = testing::described(std::move(trace));
  const nlohmann::json scene =
      nlohmann::json::parse(episode_scene(EpisodeView(described), nullptr).data);
  const auto places = numbers_of<float>(scene["places"]);
  ASSERT_EQ(places.size(), 2 * kPlace);
  EXPECT_NEAR(places[kPlace] - places[0], 0.1, kSinglePrecision);
}

TEST(EpisodePage, of_a_system_without_a_place_in_the_plane_has_no_ground_of_its_states) {
  const Trace trace = cart_trace();
  const std::string page = episode_page(EpisodeView(trace), {});
  EXPECT_TRUE(contains(page, "id=\"scene\""));
  const std::size_t data = page.find("id=\"scene-data\"");
  ASSERT_NE(data, std::string::npos);
  EXPECT_EQ(page.find("\"ground\"", data), std::string::npos);
  EXPECT_FALSE(contains(page, "data-scene=\"way\""));
}

TEST(EpisodeScene, says_that_the_model_has_changed_since_the_drive) {
  const testing::TemporaryFolder folder;
  const std::string path = folder.file("vehicle.xml", kVehicle);
  Trace trace = driven_trace(path);
  trace.vehicle_digest = mujoco_model_digest(path);
  EXPECT_EQ(scene_of(trace).note, "");
  std::string changed = kVehicle;
  changed.replace(changed.find("1 .5 0 1"), 8, "0 .5 1 1");  // the same number of coordinates
  (void)folder.file("vehicle.xml", changed);
  EXPECT_TRUE(contains(scene_of(trace).note, "vehicle.xml has changed since the drive"));
  trace.vehicle_digest.clear();
  EXPECT_EQ(scene_of(trace).note, "") << "of an earlier version: not known";
}

TEST(EpisodeScene, without_a_simulator_the_vehicle_stands_at_the_origin) {
  const testing::TemporaryFolder folder;
  Trace trace = driven_trace(folder.file("vehicle.xml", kVehicle));
  trace.motion = {{.time = 0.0, .qpos = {}}};
  const nlohmann::json scene = nlohmann::json::parse(scene_of(trace).data);
  EXPECT_TRUE(numbers_of<float>(scene["times"]).empty());
  const std::vector<float> expected{0.0F, 0.0F, 0.2F, 0.0F, 0.0F, 0.0F, 1.0F};
  EXPECT_EQ(numbers_of<float>(scene["places"]), expected);
}

TEST(EpisodeScene, keeps_every_nth_sample_of_a_long_drive_and_the_last_one) {
  const testing::TemporaryFolder folder;
  Trace trace = driven_trace(folder.file("vehicle.xml", kVehicle));
  trace.motion.clear();
  constexpr int kSamples = 50'001;
  for (int i = 0; i < kSamples; ++i) {
    trace.motion.push_back({.time = 1e-3 * i, .qpos = {1e-3 * i, 0.0, 0.0}});
  }
  const auto times = numbers_of<float>(nlohmann::json::parse(scene_of(trace).data)["times"]);
  EXPECT_EQ(times.size(), 16'668U);  // every third of 0 … 50,000, and the last
  EXPECT_NEAR(times[1], 3e-3, kSinglePrecision);
  EXPECT_NEAR(times.back(), 50.0, 1e-5);
}

TEST(EpisodeScene, is_left_out_with_a_note_where_the_model_is_different_or_missing) {
  const testing::TemporaryFolder folder;
  Trace trace = driven_trace(folder.file("vehicle.xml", kVehicle));
  trace.motion.back().qpos.push_back(0.0);
  EXPECT_TRUE(scene_of(trace).data.empty());
  EXPECT_TRUE(contains(scene_of(trace).note, "is not the model that was driven"));
  trace.scenario.plant.mjcf = folder / "gone.xml";
  EXPECT_TRUE(scene_of(trace).data.empty());
  EXPECT_TRUE(contains(scene_of(trace).note, "gone.xml"));
  trace.scenario.plant.mjcf.clear();
  EXPECT_TRUE(scene_of(trace).data.empty());
  EXPECT_EQ(scene_of(trace).note, "");
}

std::string page_of(const Trace& trace) { return episode_page(EpisodeView(trace), {}); }

TEST(EpisodeScene, only_pages_with_one_carry_its_script_and_their_policy_allows_it) {
  const testing::TemporaryFolder folder;
  Trace trace = driven_trace(folder.file("vehicle.xml", kVehicle));
  const std::string with = page_of(trace);
  trace.scenario.plant.mjcf = folder / "gone.xml";
  const std::string without = page_of(trace);
  EXPECT_TRUE(contains(with, "id=\"scene-data\""));
  EXPECT_TRUE(contains(with, "three.js authors"));  // its licence
  EXPECT_FALSE(contains(without, "id=\"scene-data\""));
  EXPECT_FALSE(contains(without, "three.js authors"));
  EXPECT_FALSE(contains(without, "id=\"scene\""));
  EXPECT_TRUE(contains(without, "No view in three dimensions: "));
  const auto policy_hashes = [](const std::string& page) {
    return occurrences(page.substr(0, page.find("<style>")), "'sha256-");
  };
  EXPECT_EQ(policy_hashes(with), 3);  // style and two scripts
  EXPECT_EQ(policy_hashes(without), 2);
}

}  // namespace episode_scene_test
}  // namespace qsmpc::harness
