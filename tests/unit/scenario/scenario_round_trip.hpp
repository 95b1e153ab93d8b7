// A scenario written as YAML reads back the same: value by value, then byte by byte.
#pragma once

#include <cstddef>
#include <string>

#include <gtest/gtest.h>

#include "harness/scenario/scenario_file.hpp"

namespace qsmpc::harness {

inline void expect_equal(const models::ObstacleMotion& a, const models::ObstacleMotion& b) {
  ASSERT_EQ(a.ways.size(), b.ways.size());
  for (std::size_t i = 0; i < a.ways.size(); ++i) {
    EXPECT_EQ(a.ways[i].probability, b.ways[i].probability);
    EXPECT_EQ(a.ways[i].onward, b.ways[i].onward);
    ASSERT_EQ(a.ways[i].points.size(), b.ways[i].points.size());
    for (std::size_t k = 0; k < a.ways[i].points.size(); ++k) {
      EXPECT_EQ(a.ways[i].points[k].time, b.ways[i].points[k].time);
      EXPECT_EQ(a.ways[i].points[k].place, b.ways[i].points[k].place);
    }
  }
  EXPECT_EQ(a.start_deviation, b.start_deviation);
  EXPECT_EQ(a.speed_deviation, b.speed_deviation);
  EXPECT_EQ(a.memory, b.memory);
  EXPECT_EQ(a.returns_in, b.returns_in);
  EXPECT_EQ(a.covariance_rate, b.covariance_rate);
  EXPECT_EQ(a.seen_deviation, b.seen_deviation);
  EXPECT_EQ(a.turns, b.turns);
  EXPECT_EQ(a.yields, b.yields);
}

inline void expect_equal(const Scenario& a, const Scenario& b) {
  EXPECT_EQ(a.name, b.name);
  EXPECT_EQ(a.description, b.description);
  EXPECT_EQ(a.seed, b.seed);
  EXPECT_EQ(a.model.system, b.model.system);
  EXPECT_EQ(a.model.parameters, b.model.parameters);
  EXPECT_EQ(a.plant.kind, b.plant.kind);
  EXPECT_EQ(a.plant.mjcf, b.plant.mjcf);
  EXPECT_EQ(a.time_step, b.time_step);
  EXPECT_EQ(a.initial_state.mean, b.initial_state.mean);
  EXPECT_EQ(a.initial_state.covariance, b.initial_state.covariance);
  EXPECT_EQ(a.disturbance.covariance, b.disturbance.covariance);
  EXPECT_EQ(a.disturbance.sensor, b.disturbance.sensor);
  EXPECT_EQ(a.safe_set.bounds.lower, b.safe_set.bounds.lower);
  EXPECT_EQ(a.safe_set.bounds.upper, b.safe_set.bounds.upper);
  ASSERT_EQ(a.safe_set.obstacles.size(), b.safe_set.obstacles.size());
  for (std::size_t i = 0; i < a.safe_set.obstacles.size(); ++i) {
    const controller::Obstacle& one = a.safe_set.obstacles[i];
    const controller::Obstacle& other = b.safe_set.obstacles[i];
    ASSERT_EQ(one.form.index(), other.form.index());
    ASSERT_EQ(one.motion.has_value(), other.motion.has_value());
    if (one.motion) expect_equal(*one.motion, *other.motion);
    if (one.box() != nullptr) {
      EXPECT_EQ(one.box()->lower, other.box()->lower);
      EXPECT_EQ(one.box()->upper, other.box()->upper);
    } else {
      EXPECT_EQ(one.shape()->index(), other.shape()->index());
      EXPECT_EQ(controller::shape_outline(*one.shape()), controller::shape_outline(*other.shape()));
    }
  }
  EXPECT_EQ(a.target.state, b.target.state);
  EXPECT_EQ(a.target.radius, b.target.radius);
  EXPECT_EQ(a.target.angles, b.target.angles);
  EXPECT_EQ(a.target.path.rows, b.target.path.rows);
  EXPECT_EQ(a.target.path.closed, b.target.path.closed);
  EXPECT_EQ(a.target.path.fast, b.target.path.fast);
  EXPECT_EQ(a.target.path.speed, b.target.path.speed);
  EXPECT_EQ(a.target.path.laps, b.target.path.laps);
  EXPECT_EQ(a.estimator.kind, b.estimator.kind);
  EXPECT_EQ(a.step_limit, b.step_limit);
  EXPECT_EQ(a.stop_when_unsafe, b.stop_when_unsafe);
  EXPECT_EQ(a.video.camera, b.video.camera);
  EXPECT_EQ(a.video.width, b.video.width);
  EXPECT_EQ(a.video.height, b.video.height);
  EXPECT_EQ(a.video.fps, b.video.fps);
  EXPECT_EQ(a.video.overlays, b.video.overlays);
}

inline void expect_equal(const Scenario::Controller& a, const Scenario::Controller& b) {
  EXPECT_EQ(a.kind, b.kind);
  EXPECT_EQ(a.lqr_about, b.lqr_about);
  EXPECT_TRUE(a.mppi == b.mppi);
  EXPECT_EQ(a.horizon, b.horizon);
  EXPECT_EQ(a.policy, b.policy);
  EXPECT_EQ(a.feedback_gain, b.feedback_gain);
  EXPECT_EQ(a.optimise_gain, b.optimise_gain);
  EXPECT_EQ(a.solver, b.solver);
  EXPECT_EQ(a.input_bounding, b.input_bounding);
  EXPECT_EQ(a.quantisation.state, b.quantisation.state);
  EXPECT_EQ(a.quantisation.noise, b.quantisation.noise);
  EXPECT_EQ(a.quantisation.compressed, b.quantisation.compressed);
  EXPECT_EQ(a.quantisation.quantiser, b.quantisation.quantiser);
  EXPECT_EQ(a.quantisation.tolerance, b.quantisation.tolerance);
  EXPECT_EQ(a.propagate_noise, b.propagate_noise);
  EXPECT_EQ(a.propagator, b.propagator);
  EXPECT_EQ(a.cost.state, b.cost.state);
  EXPECT_EQ(a.cost.input, b.cost.input);
  EXPECT_EQ(a.cost.terminal, b.cost.terminal);
  EXPECT_EQ(a.penalty.shape, b.penalty.shape);
  EXPECT_EQ(a.penalty.box, b.penalty.box);
  EXPECT_EQ(a.penalty.obstacle, b.penalty.obstacle);
  EXPECT_EQ(a.penalty.length, b.penalty.length);
  EXPECT_EQ(a.input_lower, b.input_lower);
  EXPECT_EQ(a.input_upper, b.input_upper);
  EXPECT_EQ(a.max_iterations, b.max_iterations);
  EXPECT_EQ(a.deadline, b.deadline);
  EXPECT_EQ(a.threads, b.threads);
}

// Equal values, and equal bytes when written again.
inline void expect_round_trip(const Scenario& scenario) {
  const std::string text = to_yaml(scenario);
  SCOPED_TRACE(text);
  const Scenario back = parse_scenario(text);
  expect_equal(scenario, back);
  expect_equal(scenario.controller, back.controller);
  EXPECT_EQ(to_yaml(back), text);
}

}  // namespace qsmpc::harness
