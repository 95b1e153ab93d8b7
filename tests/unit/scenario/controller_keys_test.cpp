// The keys of the controller and the estimator: names, dependent defaults, writing back.
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "controller/control/controller.hpp"
#include "controller/estimation/estimator.hpp"
#include "controller/measure/quantisation/gaussian_quantiser.hpp"
#include "controller/planning/solvers/ocp_solver.hpp"
#include "controller/prediction/propagator.hpp"
#include "harness/scenario/scenario_file.hpp"
#include "models/constants.hpp"
#include "tests/unit/scenario/scenario_fixture.hpp"
#include "tests/unit/scenario/scenario_round_trip.hpp"

namespace qsmpc::harness {
namespace controller_keys_test {

using ::testing::HasSubstr;
using ::testing::Not;

TEST(ControllerKeys, every_controller_and_estimator_can_be_named) {
  for (const controller::ControllerEntry& entry : controller::controllers()) {
    const Scenario scenario = minimal_with({"controller.kind=" + entry.name});
    EXPECT_EQ(scenario.controller.kind, entry.name);
    expect_round_trip(scenario);
  }
  const Scenario about_target =
      minimal_with({"controller.kind=lqr", "controller.lqr.about=target"});
  EXPECT_EQ(about_target.controller.lqr_about, "target");
  expect_round_trip(about_target);
  for (const controller::EstimatorEntry& entry : controller::estimators()) {
    const Scenario scenario = minimal_with({"estimator.kind=" + entry.name});
    EXPECT_EQ(scenario.estimator.kind, entry.name);
    expect_round_trip(scenario);
  }
  const Scenario noisy = minimal_with({"disturbance.sensor=[1, 1, 1]"});
  EXPECT_EQ(noisy.estimator.kind, "last_measurement");
  expect_round_trip(noisy);
}

// These are incompatible with the open loop or the solver of the text above.
TEST(ControllerKeys, gains_can_be_optimised_and_another_solver_be_named) {
  const Scenario gains = minimal_with({"controller.optimise_gain=true"});
  EXPECT_TRUE(gains.controller.optimise_gain);
  expect_round_trip(gains);
  const Scenario other = minimal_with({"controller.solver=slsqp"});
  EXPECT_EQ(other.controller.solver, "slsqp");
  EXPECT_EQ(other.controller.input_bounding, "bounded");
  expect_round_trip(other);
}

TEST(ControllerKeys, a_guide_needs_a_controller_that_follows_it_and_bounds_of_the_plane) {
  const std::string bounded = minimal_text + "safe_set: {bounds: {x: [-1, 9], y: [-1, 9]}}\n";
  const Scenario scenario =
      parse_scenario(bounded, {.file = "t.yaml", .overrides = {"controller.guide=grid"}});
  EXPECT_EQ(scenario.controller.guide, "grid");
  expect_round_trip(scenario);
  EXPECT_EQ(refusal_of(bounded, {"controller.guide=grid", "controller.kind=lqr"}).key,
            "controller.guide");
  EXPECT_THAT(refusal_of(bounded, {"controller.guide=grid", "controller.kind=shield",
                                   "controller.shield.of=lqr"})
                  .expected,
              HasSubstr("that takes one: quantised, "));
  EXPECT_EQ(
      parse_scenario(bounded, {.file = "t.yaml",
                               .overrides = {"controller.guide=grid", "controller.kind=shield",
                                             "controller.shield.of=mppi"}})
          .controller.guide,
      "grid");
  EXPECT_THAT(refusal_of(minimal_text, {"controller.guide=grid"}).expected,
              HasSubstr("finite safe_set.bounds of x"));
}

TEST(ControllerKeys, chance_constraints_are_read_written_and_refused) {
  const Scenario cvar = minimal_with(
      {"controller.kind=cvar", "controller.chance={risk: 0.1, paths: 30, smoothing: 0.2}"});
  EXPECT_EQ(cvar.controller.chance.risk, 0.1);
  EXPECT_EQ(cvar.controller.chance.paths, 30);
  EXPECT_EQ(cvar.controller.chance.smoothing, 0.2);
  expect_round_trip(cvar);
  const Scenario sampled =
      minimal_with({"controller.kind=scenario", "controller.chance.confidence=0.8"});
  EXPECT_EQ(sampled.controller.chance.confidence, 0.8);
  expect_round_trip(sampled);
  const Scenario robust = minimal_with({"controller.kind=drcc", "controller.chance.radius=0.3"});
  EXPECT_EQ(robust.controller.chance.radius, 0.3);
  expect_round_trip(robust);
  for (const char* risk : {"0", "0.6", "-0.1"}) {
    const std::string wrong = std::string("controller.chance.risk=") + risk;
    EXPECT_EQ(refusal_of(minimal_text, {"controller.kind=cone", wrong}).key,
              "controller.chance.risk");
  }
}

TEST(ControllerKeys, of_chance_constraints_and_the_shield_are_refused_where_they_have_no_effect) {
  const std::vector<std::pair<const char*, const char*>> idle{
      {"quantised", "chance.risk=0.1"},
      {"cone", "chance.paths=30"},
      {"cvar", "chance.confidence=0.8"},
      {"cvar", "chance.radius=0.3"},
      {"scenario", "chance.smoothing=0.2"},
      {"scenario", "chance.memory=3"},
      {"lqr", "shield.of=lqr"},
      {"tube", "shield.limit=0.1"},
      {"tube", "shield.stages=2"},
  };
  for (const auto& [kind, setting] : idle) {
    const std::string written = std::string("controller.") + setting;
    EXPECT_EQ(refusal_of(minimal_text, {std::string("controller.kind=") + kind, written}).key,
              written.substr(0, written.find('=')));
  }
  // Resolved scenarios of other controllers contain the default as well.
  EXPECT_NO_THROW(minimal_with(
      {"controller.kind=cone",
       "controller.chance.radius=" + std::to_string(controller::ChanceSettings{}.radius)}));
}

TEST(ControllerKeys, inputs_answer_to_noise_only_where_paths_are_sampled) {
  const std::string answers = "controller.policy=disturbance_feedback";
  const Scenario scenario =
      minimal_with({"controller.kind=scenario", answers, "controller.chance.memory=3"});
  EXPECT_EQ(scenario.controller.disturbance_memory, 3);
  expect_round_trip(scenario);
  for (const char* kind : {"quantised", "nominal", "cone", "tube"}) {
    const std::string other = std::string("controller.kind=") + kind;
    EXPECT_EQ(refusal_of(minimal_text, {other, answers}).key, "controller.policy");
  }
}

TEST(ControllerKeys, of_what_a_shield_is_about_are_kept) {
  const Scenario sampling = minimal_with(
      {"controller.kind=shield", "controller.shield.of=mppi", "controller.mppi.samples=77"});
  EXPECT_EQ(sampling.controller.mppi.samples, 77);
  expect_round_trip(sampling);
  const Scenario robust = minimal_with(
      {"controller.kind=shield", "controller.shield.of=drcc", "controller.chance.radius=0.3"});
  EXPECT_EQ(robust.controller.chance.radius, 0.3);
  expect_round_trip(robust);
  const Scenario lqr = minimal_with(
      {"controller.kind=shield", "controller.shield.of=lqr", "controller.lqr.about=target"});
  EXPECT_EQ(lqr.controller.lqr_about, "target");
  expect_round_trip(lqr);
}

TEST(ControllerKeys, a_shield_is_about_another_controller) {
  const Scenario scenario = minimal_with(
      {"controller.kind=shield", "controller.shield={of: lqr, limit: 0.1, stages: 2}"});
  EXPECT_EQ(scenario.controller.shield.of, "lqr");
  EXPECT_EQ(scenario.controller.shield.limit, 0.1);
  EXPECT_EQ(scenario.controller.shield.stages, 2);
  expect_round_trip(scenario);
  for (const char* of : {"shield", "external"}) {
    const std::string wrong = std::string("controller.shield.of=") + of;
    EXPECT_EQ(refusal_of(minimal_text, {"controller.kind=shield", wrong}).key,
              "controller.shield.of");
  }
}

TEST(ControllerKeys, every_bounding_of_the_inputs_can_be_named) {
  for (const controller::InputBoundingEntry& entry : controller::input_boundings()) {
    const Scenario scenario = minimal_with({"controller.input_bounding=" + entry.name});
    EXPECT_EQ(scenario.controller.input_bounding, entry.name);
    expect_round_trip(scenario);
  }
}

TEST(ControllerKeys, penalties_weigh_nothing_by_default_where_limits_of_the_risk_are_kept) {
  const auto weights = [](const std::vector<std::string>& overrides) {
    const Scenario::Penalty& penalty = minimal_with(overrides).controller.penalty;
    return std::pair(penalty.box, penalty.obstacle);
  };
  const std::pair usual(450.0, 400.0);
  EXPECT_EQ(weights({}), usual);
  EXPECT_EQ(weights({"risk.plan=0.02"}), std::pair(0.0, 0.0));
  EXPECT_EQ(weights({"risk.mission=0.02"}), std::pair(0.0, 0.0));
  // These controllers ignore limits and would drive into everything.
  EXPECT_EQ(weights({"risk.plan=0.02", "controller.kind=nominal"}), usual);
  EXPECT_EQ(weights({"risk.plan=0.02", "controller.kind=lqr"}), usual);
  EXPECT_EQ(weights({"risk.plan=0.02", "controller.penalty.box=7"}), std::pair(7.0, 0.0));
  const Scenario limited = minimal_with({"risk.plan=0.02"});
  const Scenario again = parse_scenario(to_yaml(limited), {.file = "again.yaml"});
  EXPECT_EQ(again.controller.penalty.box, 0.0);
}

TEST(ControllerKeys, a_deadline_is_written_only_if_there_is_one) {
  const Scenario some = minimal_with({"controller.deadline=0.30000000000000004"});
  EXPECT_THAT(to_yaml(some), HasSubstr("\n  deadline: 0.30000000000000004\n"));
  expect_round_trip(some);
  const Scenario none = parse_scenario(minimal_text);
  EXPECT_THAT(to_yaml(none), Not(HasSubstr("deadline")));
  expect_round_trip(none);
}

TEST(ControllerKeys, every_propagator_of_noise_and_every_quantiser_can_be_named) {
  for (const controller::PropagatorEntry& entry : controller::propagators()) {
    if (entry.name == "noise_free") continue;  // it is set by propagate_noise: false
    const Scenario scenario = minimal_with({"controller.propagator=" + entry.name});
    EXPECT_EQ(scenario.controller.propagator, entry.name);
    expect_round_trip(scenario);
  }
  for (const controller::QuantiserEntry& entry : controller::quantisers()) {
    const Scenario scenario = minimal_with({"controller.quantisation.quantiser=" + entry.name});
    EXPECT_EQ(scenario.controller.quantisation.quantiser, entry.name);
    expect_round_trip(scenario);
  }
}

TEST(ControllerKeys, points_are_given_or_left_to_a_tolerance) {
  EXPECT_EQ(minimal_with({}).controller.quantisation.tolerance, 0.0);
  EXPECT_THAT(to_yaml(minimal_with({})), Not(HasSubstr("tolerance")));
  const Scenario by_word = minimal_with({"controller.quantisation=auto"});
  EXPECT_EQ(by_word.controller.quantisation.tolerance, 1e-3);
  EXPECT_EQ(by_word.controller.quantisation.state, 100);
  expect_round_trip(by_word);
  const Scenario by_number =
      minimal_with({"controller.quantisation={state: 50, tolerance: 0.02, compressed: 60}"});
  EXPECT_EQ(by_number.controller.quantisation.tolerance, 0.02);
  EXPECT_EQ(by_number.controller.quantisation.state, 50);
  EXPECT_EQ(by_number.controller.quantisation.compressed, 60);
  expect_round_trip(by_number);
}

}  // namespace controller_keys_test
}  // namespace qsmpc::harness
