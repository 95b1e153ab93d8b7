#include "harness/report/episode_data.hpp"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "harness/report/episode_charts.hpp"
#include "harness/report/episode_map.hpp"
#include "harness/scenario/scenario_file.hpp"
#include "models/dynamics/dynamics.hpp"
#include "tests/support/described_trace.hpp"
#include "tests/support/example_trace.hpp"
#include "tests/unit/report/packed_data.hpp"

namespace qsmpc::harness {
namespace episode_data_test {

using testing::example_trace;
using testing::numbers_of;

nlohmann::json data_of(const Trace& trace) {
  const EpisodeView view(trace);
  const std::vector<Chart> charts = episode_charts(view);
  const PlaneMap map = episode_maps(view)->ground;
  return nlohmann::json::parse(episode_data(view, {.charts = charts, .map = &map}));
}

TEST(EpisodeMap, without_a_plane_shows_position_and_angle_or_velocity) {
  const auto map_of = [](const char* name) {
    Trace trace;
    trace.scenario = load_scenario(name);
    trace = testing::described(std::move(trace));
    return episode_maps(EpisodeView(trace)).value().drive;
  };
  const PlaneMap cart_pole = map_of("cart_pole");
  EXPECT_EQ(cart_pole.title, "Position and pole angle");
  EXPECT_EQ(cart_pole.x_label, "position (m)");
  EXPECT_EQ(cart_pole.y_label, "pole_angle (rad)");
  EXPECT_EQ(cart_pole.bounds.x_upper, 2.5);
  EXPECT_EQ(cart_pole.bounds.y_upper, 0.5);
  const PlaneMap line = map_of("double_integrator");
  EXPECT_EQ(line.y_label, "velocity (m/s)");
  EXPECT_EQ(line.targets.at(0).centre.x, 2.0);
  EXPECT_EQ(map_of("dubins_obstacles").title, "Map");
}

TEST(EpisodeData, particles_are_where_the_trace_has_them) {
  const Trace trace = testing::example_trace();
  const nlohmann::json particles = data_of(trace)["map"]["particles"];
  EXPECT_EQ(particles["stride"], 1);
  const auto counts = numbers_of<float>(particles["counts"]);
  const auto places = numbers_of<std::uint16_t>(particles["places"]);
  const double x_lower = particles["xLower"];
  const double x_upper = particles["xUpper"];
  ASSERT_EQ(counts.size(), trace.steps.size() * trace.steps[0].particles.size());
  std::size_t at = 0;
  for (const StepRecord& step : trace.steps) {
    for (const StageParticles& stage : step.particles) {
      for (Eigen::Index i = 0; i < stage.size(); ++i, ++at) {
        const double x = stage.locations(0, i);
        if (x < x_lower || x > x_upper || stage.locations(1, i) < particles["yLower"]) continue;
        EXPECT_NEAR(x_lower + (x_upper - x_lower) * places[2 * at] / 65534.0, x,
                    (x_upper - x_lower) / 65534.0);  // to the nearest grid position
      }
    }
  }
  EXPECT_EQ(2 * at, places.size());
}

TEST(EpisodeData, poses_are_the_true_states_and_the_last_one) {
  const Trace trace = testing::example_trace();
  const auto poses = numbers_of<float>(data_of(trace)["map"]["poses"]);
  ASSERT_EQ(poses.size(), 3 * (trace.steps.size() + 1));
  for (std::size_t k = 0; k < trace.steps.size(); ++k) {
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_EQ(poses[3 * k + i],
                static_cast<float>(trace.steps[k].state[static_cast<Eigen::Index>(i)]));
    }
  }
  EXPECT_EQ(poses[3 * trace.steps.size()], static_cast<float>(trace.final_state[0]));
}

TEST(EpisodeData, what_is_not_finite_is_nowhere) {
  Trace trace = testing::example_trace();
  trace.steps[0].particles[0].locations(0, 0) = std::numeric_limits<double>::quiet_NaN();
  trace.steps[0].particles[0].locations(1, 0) = 1e9;
  const auto places = numbers_of<std::uint16_t>(data_of(trace)["map"]["particles"]["places"]);
  EXPECT_EQ(places[0], 65535);
  EXPECT_EQ(places[1], 65535);
}

TEST(EpisodeData, a_page_does_not_hold_more_particles_than_it_should) {
  const Trace trace = testing::example_trace({.steps = 400, .horizon = 18, .points = 120});
  std::size_t all = 0;
  for (const StepRecord& step : trace.steps) {
    for (const StageParticles& stage : step.particles) {
      all += static_cast<std::size_t>(stage.size());
    }
  }
  ASSERT_GT(all, 400'000U);
  const nlohmann::json particles = data_of(trace)["map"]["particles"];
  EXPECT_GE(particles["stride"], 2);
  const std::size_t kept = numbers_of<std::uint8_t>(particles["sizes"]).size();
  EXPECT_LT(kept, 450'000U);  // the first particle of a stage is always kept
  EXPECT_GT(kept, all / (particles["stride"].get<std::size_t>() + 1));
}

TEST(EpisodeData, ellipses_have_the_moments_of_the_particles) {
  Trace trace = testing::example_trace();
  StageParticles& stage = trace.steps[2].particles[1];
  stage.locations = Eigen::Matrix3Xd::Zero(3, 2);
  stage.locations.col(0) << 1.0, 2.0, 0.0;
  stage.locations.col(1) << 3.0, 6.0, 0.0;
  stage.weights = Eigen::Vector2d(0.75, 0.25);
  const auto moments = numbers_of<float>(data_of(trace)["map"]["moments"]);
  const std::size_t at = 5 * (2 * trace.steps[2].particles.size() + 1);
  const std::vector<float> five(moments.begin() + static_cast<std::ptrdiff_t>(at),
                                moments.begin() + static_cast<std::ptrdiff_t>(at + 5));
  // Means 1.5 and 3; squared distances 4 and 16, their product 8, times 0.75 · 0.25.
  EXPECT_EQ(five, (std::vector<float>{1.5F, 3.0F, 0.75F, 1.5F, 3.0F}));
}

}  // namespace episode_data_test
}  // namespace qsmpc::harness
