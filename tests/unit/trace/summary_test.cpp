#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>
#include <utility>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "harness/scenario/scenario_file.hpp"
#include "harness/trace/ending.hpp"
#include "harness/trace/episode_view.hpp"
#include "tests/support/described_trace.hpp"

namespace qsmpc::harness {
namespace summary_test {

/// Straight ahead at 1.5 m/s from (0, 0) with heading 0: the model moves 0.15 m along x per period.
Trace straight_trace(int steps) {
  Trace trace;
  trace.scenario = parse_scenario(
      "name: straight\nmodel: {system: dubins, speed: 1.5}\nplant: {kind: analytic, mjcf: \"\"}\n"
      "time_step: 0.1\ninitial_state: {mean: [0, 0, 0]}\n"
      "safe_set: {bounds: {y: [-1, 2]}}\ntarget: {state: [5, 0, 0], radius: 0.5}\n"
      "controller: {horizon: 2, cost: {state: [2, 4, 0], input: [3], terminal: [1, 1, 1]}}\n");
  trace.seed = 9;
  trace.version = "1.2.3";
  for (int k = 0; k < steps; ++k) {
    StepRecord step;
    step.time = 0.1 * k;
    step.state = Eigen::Vector3d(0.15 * k, 0.0, 0.0);
    step.input = Eigen::VectorXd::Zero(1);
    step.disturbance = Eigen::Vector3d::Zero();
    step.certificates.assign(2, controller::blank_certificate());
    const std::size_t published = controller::certificate_index("thesis");
    step.certificates[0].value = 0.01 * (k + 1);
    step.certificates[1].value = 0.5;
    step.certificates[0].figures[published] = 0.25;
    step.certificates[1].figures[published] = 0.125;
    step.timing.total = k + 1;
    step.timing.certify = 7.0;
    step.iterations = 10 + k;
    trace.steps.push_back(step);
  }
  trace.final_state = Eigen::Vector3d(0.15 * steps, 0.0, 0.0);
  return testing::described(std::move(trace));
}

TEST(Summary, adds_the_stage_costs_of_the_true_states) {
  Trace trace = straight_trace(2);
  trace.steps[1].state = Eigen::Vector3d(4.0, 1.0, 0.3);
  trace.steps[1].input[0] = -2.0;
  // ½ (2·5²) + 0, and ½ (2·1² + 4·1² + 0) + 3·2².
  EXPECT_DOUBLE_EQ(EpisodeView(trace).summary().closed_loop_cost, 25.0 + 3.0 + 12.0);
}

TEST(Summary, says_whether_its_certificates_are_bounds) {
  Trace trace = straight_trace(2);
  EXPECT_EQ(nlohmann::json::parse(summary_json(EpisodeView(trace)))["certificate"]["holds"], true);
  trace.scenario.disturbance.sensor = Eigen::Matrix3d::Identity();
  const auto json = nlohmann::json::parse(summary_json(EpisodeView(trace)));
  EXPECT_EQ(json["certificate"]["holds"], false);
  EXPECT_EQ(json["certificate"]["reason"],
            "with measurement noise (disturbance.sensor), the feedback acts on what is observed, "
            "not on the true state");
}

TEST(Summary, counts_periods_of_touching_that_follow_each_other_once) {
  Trace trace = straight_trace(6);
  EXPECT_FALSE(EpisodeView(trace).summary().contacts.has_value());
  for (StepRecord& step : trace.steps) step.contact.force = 0.0;
  EXPECT_EQ(EpisodeView(trace).summary().contacts, 0);
  for (const std::size_t k : {1U, 2U, 4U}) {
    trace.steps[k].contact = {.force = 10.0 * static_cast<double>(k),
                              .time = trace.steps[k].time + 0.05};
  }
  const Summary summary = EpisodeView(trace).summary();
  EXPECT_EQ(summary.contacts, 2);
  EXPECT_DOUBLE_EQ(*summary.first_contact, 0.15);
  EXPECT_EQ(summary.largest_contact, 40.0);
}

TEST(Summary, headings_a_turn_apart_cost_the_same_where_the_target_is_meant_modulo_a_turn) {
  Trace trace = straight_trace(1);
  trace.scenario.controller.cost.state(2, 2) = 6.0;
  trace.steps[0].state[2] = 0.1 + 2.0 * std::numbers::pi;
  EXPECT_GT(EpisodeView(trace).summary().closed_loop_cost, 100.0);
  trace.scenario.target.angles = {2};
  // ½ (2·5² + 6·0.1²), up to rounding of the heading.
  EXPECT_NEAR(EpisodeView(trace).summary().closed_loop_cost, 25.03, 1e-13);
}

TEST(Summary, clearance_and_collision_are_those_of_all_true_states) {
  Trace trace = straight_trace(3);
  EXPECT_DOUBLE_EQ(EpisodeView(trace).summary().min_clearance, 1.0);
  EXPECT_FALSE(EpisodeView(trace).summary().collision);
  trace.final_state[1] = 2.5;  // beyond the bound at 2
  EXPECT_DOUBLE_EQ(EpisodeView(trace).summary().min_clearance, -0.5);
  EXPECT_TRUE(EpisodeView(trace).summary().collision);
}

TEST(Summary, time_to_target_is_that_of_every_drive_that_ended_at_it) {
  Trace trace = straight_trace(4);
  trace.outcome = Outcome::kReached;
  EXPECT_DOUBLE_EQ(EpisodeView(trace).summary().time_to_target.value(), 0.4);
  // Through an obstacle and on to the target.
  trace.outcome = Outcome::kCollision;
  trace.scenario.stop_when_unsafe = false;
  EXPECT_FALSE(EpisodeView(trace).summary().time_to_target.has_value());
  trace.final_state = trace.scenario.target.state;
  EXPECT_DOUBLE_EQ(EpisodeView(trace).summary().time_to_target.value(), 0.4);
  EXPECT_EQ(EpisodeView(trace).summary().outcome, "collision");
  trace.outcome = Outcome::kFault;
  EXPECT_FALSE(EpisodeView(trace).summary().time_to_target.has_value());
  // Stopped at an obstacle next to the target.
  trace.outcome = Outcome::kLeftBounds;
  trace.scenario.stop_when_unsafe = true;
  EXPECT_FALSE(EpisodeView(trace).summary().time_to_target.has_value());
}

TEST(Outcomes, are_listed_in_the_order_of_their_names_and_unknown_ones_last) {
  const auto ordered =
      in_order({{"collision", 2}, {"fault", 0}, {"left_safe_set", 1}, {"reached", 7}});
  ASSERT_EQ(ordered.size(), 4U);
  EXPECT_EQ(ordered[0], (std::pair<std::string, std::int64_t>("reached", 7)));
  EXPECT_EQ(ordered[1].first, "collision");
  EXPECT_EQ(ordered[2].first, "fault");
  EXPECT_EQ(ordered[3].first, "left_safe_set");
}

TEST(EpisodeView, first_unsafe_time_is_that_of_the_first_unsafe_state) {
  Trace trace = straight_trace(3);
  EXPECT_FALSE(EpisodeView(trace).first_unsafe_time().has_value());
  trace.final_state[1] = 2.5;
  EXPECT_DOUBLE_EQ(EpisodeView(trace).first_unsafe_time().value(), 0.3);
  trace.steps[1].state[1] = -1.0;  // on the bound
  EXPECT_DOUBLE_EQ(EpisodeView(trace).first_unsafe_time().value(), 0.1);
}

TEST(Summary, quantiles_are_nearest_ranks) {
  const Summary summary = EpisodeView(straight_trace(200)).summary();  // totals 1 … 200 ms
  EXPECT_DOUBLE_EQ(summary.ocp_ms.median, 100.0);
  EXPECT_DOUBLE_EQ(summary.ocp_ms.p95, 190.0);
  EXPECT_DOUBLE_EQ(summary.ocp_ms.p99, 198.0);
  EXPECT_DOUBLE_EQ(summary.ocp_ms.max, 200.0);
  EXPECT_DOUBLE_EQ(summary.ocp_ms.mean, 100.5);
  EXPECT_DOUBLE_EQ(summary.breakdown.certify, 7.0);
  EXPECT_EQ(summary.deadline_misses, 100);  // those above 100 ms
}

TEST(Summary, counts_the_plans_that_fell_back_and_those_cut_short) {
  Trace trace = straight_trace(4);
  for (const std::size_t k : {0U, 2U, 3U}) trace.steps[k].solver_status = "deadline";
  trace.steps[1].solver_status = "iteration_limit";
  trace.steps[1].fallback = true;
  const auto json = nlohmann::json::parse(summary_json(EpisodeView(trace)));
  EXPECT_EQ(json["ocp"]["deadline_stops"], 3);
  EXPECT_EQ(json["ocp"]["fallbacks"], 1);
}

TEST(Summary, certificates_are_summed_over_a_plan_and_along_the_drive) {
  const Summary summary = EpisodeView(straight_trace(3)).summary();
  EXPECT_DOUBLE_EQ(summary.next_step_max, 0.03);
  EXPECT_DOUBLE_EQ(summary.next_step_sum, 0.06);
  EXPECT_DOUBLE_EQ(summary.next_step_mean, 0.02);
  EXPECT_DOUBLE_EQ(summary.horizon_max, 0.53);
  EXPECT_DOUBLE_EQ(summary.thesis_max, 0.25);
}

TEST(Summary, believed_is_summed_where_every_period_has_an_estimate) {
  Trace trace = straight_trace(3);
  EXPECT_EQ(nlohmann::json::parse(summary_json(EpisodeView(trace)))["believed"]["next_step"],
            nullptr);
  for (std::size_t k = 0; k < 3; ++k) trace.steps[k].believed = 0.125 * static_cast<double>(k);
  const auto json = nlohmann::json::parse(summary_json(EpisodeView(trace)))["believed"];
  EXPECT_EQ(json["next_step"]["max"], 0.25);
  EXPECT_EQ(json["next_step"]["mean"], 0.125);
  EXPECT_EQ(json["next_step"]["sum"], 0.375);
  trace.steps[1].believed = std::nan("");
  EXPECT_FALSE(EpisodeView(trace).summary().believed);
}

TEST(Summary, risk_is_held_against_its_limits) {
  Trace trace = straight_trace(3);  // certificates 0.01, 0.02, 0.03 of the next step, then 0.5
  trace.scenario.risk = {.stage = 0.5, .plan = 0.515, .mission = 0.05};
  const auto json = nlohmann::json::parse(summary_json(EpisodeView(trace)));
  EXPECT_EQ(json["risk"]["stage"], nlohmann::json::parse(R"({"limit": 0.5, "certified_max": 0.5,
                                                             "exceeded": 0})"));
  EXPECT_EQ(json["risk"]["plan"]["limit"], 0.515);
  EXPECT_DOUBLE_EQ(json["risk"]["plan"]["certified_max"], 0.53);
  EXPECT_EQ(json["risk"]["plan"]["exceeded"], 2);
  EXPECT_DOUBLE_EQ(json["risk"]["mission"]["certified_max"], 0.06);
  EXPECT_EQ(json["risk"]["mission"]["exceeded"], true);
  EXPECT_EQ(json["mission"]["spent"], json["risk"]["mission"]["certified_max"]);
  EXPECT_EQ(json["mission"]["limit"], 0.05);
}

TEST(Summary, risk_without_limits_is_certified_and_not_exceeded) {
  Trace trace = straight_trace(2);
  trace.steps[1].certificates[1].value = 0.999;  // the plan's sum exceeds 1
  const auto json = nlohmann::json::parse(summary_json(EpisodeView(trace)));
  for (const char* kind : {"stage", "plan", "mission"}) {
    EXPECT_TRUE(json["risk"][kind]["limit"].is_null()) << kind;
    EXPECT_TRUE(json["risk"][kind]["exceeded"].is_null()) << kind;
  }
  EXPECT_EQ(json["risk"]["stage"]["certified_max"], 0.999);
  EXPECT_EQ(json["risk"]["plan"]["certified_max"], 1.0);
  EXPECT_DOUBLE_EQ(json["mission"]["spent"], 0.03);
  EXPECT_TRUE(json["mission"]["limit"].is_null());
}

TEST(Summary, mission_is_within_its_limit_where_the_sum_is) {
  Trace trace = straight_trace(3);
  trace.scenario.risk.mission = 0.07;
  EXPECT_EQ(EpisodeView(trace).summary().risk.mission.exceeded, 0);
  trace.scenario.risk.mission = 0.0;  // from the first period on
  EXPECT_EQ(EpisodeView(trace).summary().risk.mission.exceeded, 3);
}

TEST(Summary, a_period_that_exceeds_several_limits_counts_once) {
  Trace trace = straight_trace(3);  // plans of 0.51, 0.52, 0.53; spent 0.01, 0.03, 0.06
  EXPECT_EQ(EpisodeView(trace).summary().risk.exceeded_periods, 0) << "without limits";
  trace.scenario.risk = {.plan = 0.525, .mission = 0.02};
  EXPECT_EQ(EpisodeView(trace).summary().risk.exceeded_periods, 2);
  trace.steps[0].solver_status = "risk_exceeded";
  EXPECT_EQ(EpisodeView(trace).summary().risk.exceeded_periods, 3);
}

TEST(Summary, mismatch_is_what_the_model_and_the_disturbance_leave) {
  Trace trace = straight_trace(2);
  EXPECT_TRUE(EpisodeView(trace).summary().mismatch_rmse.isZero(1e-15));  // rounding
  // The second period ends 0.02 further in y, of which 0.03 was disturbance.
  trace.final_state[1] = 0.02;
  trace.steps[1].disturbance[1] = 0.03;
  trace = testing::described(std::move(trace));
  const Summary summary = EpisodeView(trace).summary();
  EXPECT_NEAR(summary.mismatch_mean[1], -0.005, 1e-15);
  EXPECT_NEAR(summary.mismatch_rmse[1], 0.01 / std::sqrt(2.0), 1e-15);
  EXPECT_NEAR(summary.mismatch_covariance(1, 1), 0.005 * 0.005, 1e-15);
}

TEST(EpisodeView, of_a_trace_without_residuals_is_refused) {
  Trace trace = straight_trace(2);
  trace.steps[1].residual.resize(0);
  EXPECT_THROW((void)EpisodeView(trace), std::invalid_argument);
}

TEST(Summary, json_has_every_documented_key) {
  Trace trace = straight_trace(4);
  trace.outcome = Outcome::kReached;
  const auto json =
      nlohmann::json::parse(summary_json(EpisodeView(trace), {.video_file = "a.mp4"}));
  for (const char* pointer : {"/scenario",
                              "/seed",
                              "/version",
                              "/outcome",
                              "/steps",
                              "/time_to_target",
                              "/collision",
                              "/min_clearance",
                              "/cost/closed_loop",
                              "/ocp_ms/median",
                              "/ocp_ms/p95",
                              "/ocp_ms/p99",
                              "/ocp_ms/max",
                              "/ocp_ms/mean",
                              "/ocp_ms/breakdown/quantise",
                              "/ocp_ms/breakdown/propagate",
                              "/ocp_ms/breakdown/optimise",
                              "/ocp_ms/breakdown/certify",
                              "/deadline_misses",
                              "/ocp/iterations/median",
                              "/ocp/fallbacks",
                              "/ocp/deadline_stops",
                              "/certificate/next_step/max",
                              "/certificate/next_step/mean",
                              "/certificate/horizon/max",
                              "/certificate/thesis/max",
                              "/risk/stage/certified_max",
                              "/risk/plan/certified_max",
                              "/risk/mission/certified_max",
                              "/mission/spent",
                              "/mission/limit",
                              "/mismatch/one_step/rmse",
                              "/mismatch/one_step/mean",
                              "/mismatch/one_step/covariance",
                              "/video"}) {
    EXPECT_TRUE(json.contains(nlohmann::json::json_pointer(pointer))) << pointer;
  }
  EXPECT_EQ(json["outcome"], "reached");
  EXPECT_DOUBLE_EQ(json["time_to_target"], 0.4);
  EXPECT_EQ(json["video"], "a.mp4");
  EXPECT_EQ(json["mismatch"]["one_step"]["covariance"].size(), 3U);
}

TEST(Summary, an_episode_that_broke_before_it_began_has_one_too) {
  Trace trace = straight_trace(0);
  trace.outcome = Outcome::kFault;
  trace.fault = "words \xff of the simulator";  // invalid UTF-8
  trace.final_state = Eigen::Vector3d::Zero();
  const auto json = nlohmann::json::parse(summary_json(EpisodeView(trace)));
  EXPECT_EQ(json["steps"], 0);
  EXPECT_EQ(json["outcome"], "fault");
  EXPECT_TRUE(json["time_to_target"].is_null());
  EXPECT_TRUE(json["video"].is_null());
}

}  // namespace summary_test
}  // namespace qsmpc::harness
