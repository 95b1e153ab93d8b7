#include "harness/trace/summary.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "controller/planning/cost/angular_target.hpp"
#include "controller/planning/solvers/ocp_solver.hpp"
#include "harness/scenario/certificate_scope.hpp"
#include "harness/scenario/model_dynamics.hpp"
#include "harness/text/json_text.hpp"
#include "harness/trace/ending.hpp"
#include "harness/trace/episode_view.hpp"
#include "harness/trace/json_values.hpp"
#include "models/constants.hpp"

namespace qsmpc::harness {
namespace {

constexpr double kMillisecondsPerSecond = 1e3;

template <class Value>
Distribution over_steps(const Trace& trace, const Value& value) {
  std::vector<double> values;
  values.reserve(trace.steps.size());
  for (const StepRecord& step : trace.steps) values.push_back(value(step));
  return distribution_or_zeros(std::move(values));
}

template <class Value>
double median_over_steps(const Trace& trace, const Value& value) {
  return over_steps(trace, value).median;
}

void add_clearance(const EpisodeView& view, Summary& summary) {
  summary.min_clearance = kInfinity;
  for (const double clearance : view.clearances()) {
    summary.min_clearance = std::min(summary.min_clearance, clearance);
  }
  summary.collision = summary.min_clearance <= 0.0;
}

/// Adds what the plant reports from between the control instants.
void add_between(const Trace& trace, Summary& summary) {
  bool touches = false;  // in the previous period
  for (const StepRecord& step : trace.steps) {
    if (!std::isnan(step.clearance_between)) {
      summary.unsafe_between =
          summary.unsafe_between.value_or(false) || step.clearance_between <= 0.0;
    }
    if (std::isnan(step.contact.force)) continue;
    const bool touched = touches;
    touches = !std::isnan(step.contact.time);
    summary.contacts = summary.contacts.value_or(0) + (touches && !touched ? 1 : 0);
    if (touches && !summary.first_contact) summary.first_contact = step.contact.time;
    summary.largest_contact = std::max(summary.largest_contact, step.contact.force);
  }
}

template <class Value>
nlohmann::ordered_json or_null(const std::optional<Value>& value) {
  return value ? nlohmann::ordered_json(*value) : nlohmann::ordered_json(nullptr);
}

void add_cost(const Trace& trace, Summary& summary) {
  const std::vector<double> progress = progress_of(trace);
  for (std::size_t k = 0; k < trace.steps.size(); ++k) {
    const StepRecord& step = trace.steps[k];
    std::optional<double> now;
    if (k < progress.size()) now = progress[k];
    summary.closed_loop_cost += period_cost(trace.scenario, step.state, step.input, now);
  }
}

void add_timing(const Trace& trace, Summary& summary) {
  const auto total = [](const StepRecord& step) { return step.timing.total; };
  summary.ocp_ms = over_steps(trace, total);
  summary.breakdown.quantise =
      median_over_steps(trace, [](const auto& s) { return s.timing.quantise; });
  summary.breakdown.propagate =
      median_over_steps(trace, [](const auto& s) { return s.timing.propagate; });
  summary.breakdown.optimise =
      median_over_steps(trace, [](const auto& s) { return s.timing.optimise; });
  summary.breakdown.certify =
      median_over_steps(trace, [](const auto& s) { return s.timing.certify; });
  const double deadline = kMillisecondsPerSecond * trace.scenario.time_step;
  const std::string cut_short = controller::solver_status_name(controller::SolverStatus::kDeadline);
  for (const StepRecord& step : trace.steps) {
    if (step.timing.total > deadline) ++summary.deadline_misses;
    if (step.fallback) ++summary.fallbacks;
    if (step.solver_status == cut_short) ++summary.deadline_stops;
  }
  summary.iterations_median =
      median_over_steps(trace, [](const auto& s) { return static_cast<double>(s.iterations); });
}

void add_certificates(const EpisodeView& view, Summary& summary) {
  const Trace& trace = view.trace();
  for (const StepRecord& step : trace.steps) {
    if (step.certificates.empty()) continue;
    const double next = step.certificates.front().value;
    summary.next_step_max = std::max(summary.next_step_max, next);
    summary.next_step_sum += next;
    summary.horizon_max =
        std::max(summary.horizon_max, controller::horizon_bound(step.certificates));
    for (const controller::StageCertificate& certificate : step.certificates) {
      summary.thesis_max = std::max(summary.thesis_max, certificate.of("thesis"));
    }
  }
  if (view.parts().stages == 0) summary.horizon_max = kNotANumber;
  if (summary.steps > 0) summary.next_step_mean = summary.next_step_sum / summary.steps;
  summary.risk = risk_use(trace);
}

void add_believed(const Trace& trace, Summary& summary) {
  if (trace.steps.empty()) return;
  BelievedRisk believed;
  for (const StepRecord& step : trace.steps) {
    if (std::isnan(step.believed)) return;
    believed.max = std::max(believed.max, step.believed);
    believed.sum += step.believed;
  }
  believed.mean = believed.sum / summary.steps;
  summary.believed = believed;
}

nlohmann::ordered_json believed_json(const std::optional<BelievedRisk>& believed) {
  if (!believed) return nullptr;
  return {{"max", believed->max}, {"mean", believed->mean}, {"sum", believed->sum}};
}

nlohmann::ordered_json path_json(const Scenario& scenario, const Summary& summary) {
  nlohmann::ordered_json json{{"length", scenario.target.course->path->length()},
                              {"distance", *summary.distance},
                              {"laps", nullptr}};
  if (summary.laps) {
    json["laps"] = {{"wanted", summary.laps->wanted},
                    {"done", summary.laps->times.size()},
                    {"times", summary.laps->times}};
  }
  return json;
}

void add_mismatch(const EpisodeView& view, Summary& summary) {
  const Eigen::MatrixXd& residuals = view.residuals();
  const Eigen::Index dim = residuals.rows();
  summary.mismatch_mean = Eigen::VectorXd::Zero(dim);
  summary.mismatch_rmse = Eigen::VectorXd::Zero(dim);
  summary.mismatch_covariance = Eigen::MatrixXd::Zero(dim, dim);
  if (residuals.cols() == 0) return;
  const auto count = static_cast<double>(residuals.cols());
  summary.mismatch_mean = residuals.rowwise().mean();
  summary.mismatch_rmse = (residuals.array().square().rowwise().sum() / count).sqrt();
  const Eigen::MatrixXd centred = residuals.colwise() - summary.mismatch_mean;
  summary.mismatch_covariance = centred * centred.transpose() / count;
}

nlohmann::ordered_json timing_json(const Summary& summary) {
  return {{"median", summary.ocp_ms.median},
          {"p95", summary.ocp_ms.p95},
          {"p99", summary.ocp_ms.p99},
          {"max", summary.ocp_ms.max},
          {"mean", summary.ocp_ms.mean},
          {"breakdown",
           {{"quantise", summary.breakdown.quantise},
            {"propagate", summary.breakdown.propagate},
            {"optimise", summary.breakdown.optimise},
            {"certify", summary.breakdown.certify}}}};
}

/// `exceeded` depends on the kind of limit: a number of periods or a truth value.
nlohmann::ordered_json risk_json(const CertifiedRisk& risk, nlohmann::ordered_json exceeded) {
  nlohmann::ordered_json json{{"limit", nullptr}, {"certified_max", risk.certified}};
  if (risk.is_limited()) json["limit"] = risk.limit;
  json["exceeded"] = risk.is_limited() ? std::move(exceeded) : nullptr;
  return json;
}

void add_risk(const RiskUse& risk, nlohmann::ordered_json& json) {
  json["risk"] = {{"stage", risk_json(risk.stage, risk.stage.exceeded)},
                  {"plan", risk_json(risk.plan, risk.plan.exceeded)},
                  {"mission", risk_json(risk.mission, risk.mission.exceeded > 0)}};
  json["mission"] = {{"spent", risk.mission.certified},
                     {"limit", json["risk"]["mission"]["limit"]}};
}

}  // namespace

namespace {

/// State minus its reference.
Eigen::VectorXd offset_from_target(const Scenario& scenario, const Eigen::VectorXd& state,
                                   std::optional<double> progress) {
  const Scenario::Target& target = scenario.target;
  if (target.route) {
    return controller::target_offset(target.route->next(progress.value_or(0.0)), target.angles,
                                     state);
  }
  if (!target.course || !state.allFinite()) {
    return controller::target_offset(target.state, target.angles, state);
  }
  const models::SystemDescription system = system_of(scenario);
  const Eigen::Vector2d position(state[system.position_x], state[system.position_y]);
  Eigen::MatrixXd wanted(state.size(), 1);
  controller::path_targets(*target.course, system, state,
                           controller::progress_on(*target.course, position, {}), wanted);
  return state - wanted.col(0);
}

}  // namespace

double period_cost(const Scenario& scenario, const Eigen::VectorXd& state,
                   const Eigen::VectorXd& input, std::optional<double> progress) {
  const Scenario::Cost& cost = scenario.controller.cost;
  const Eigen::VectorXd offset = offset_from_target(scenario, state, progress);
  return 0.5 * offset.dot(cost.state * offset) + input.dot(cost.input * input);
}

Summary summarise(const EpisodeView& view) {
  const Trace& trace = view.trace();
  Summary summary;
  summary.scenario = trace.scenario.name;
  summary.seed = trace.seed;
  summary.version = trace.version;
  summary.controller = trace.scenario.controller.kind;
  summary.estimator = trace.scenario.estimator.kind;
  summary.outcome = outcome_name(trace.outcome);
  summary.fault = trace.fault;
  if (trace.outcome == Outcome::kFault) summary.fault_of = fault_of_name(trace.fault_of);
  summary.steps = static_cast<int>(trace.steps.size());
  summary.no_bound = why_no_bound(trace.scenario);
  if (const auto& course = trace.scenario.target.course) {
    const std::vector<double> along = progress_of(trace);
    if (!along.empty()) summary.distance = along.back() - course->begin;
  }
  summary.laps = laps_of(trace);
  summary.waypoints = waypoint_times(trace);
  if (ended_at_target(trace)) {
    summary.time_to_target = summary.steps * trace.scenario.time_step;
  }
  add_clearance(view, summary);
  add_between(trace, summary);
  add_cost(trace, summary);
  add_timing(trace, summary);
  add_certificates(view, summary);
  add_believed(trace, summary);
  add_mismatch(view, summary);
  return summary;
}

std::string summary_json(const EpisodeView& view, const SummaryOptions& options) {
  const Summary& summary = view.summary();
  nlohmann::ordered_json json;
  json["scenario"] = summary.scenario;
  json["seed"] = summary.seed;
  json["version"] = summary.version;
  json["controller"] = summary.controller;
  json["estimator"] = summary.estimator;
  json["outcome"] = summary.outcome;
  if (!summary.fault.empty()) json["fault"] = summary.fault;
  if (!summary.fault_of.empty()) json["fault_of"] = summary.fault_of;
  json["steps"] = summary.steps;
  json["time_to_target"] = nullptr;
  if (summary.time_to_target) json["time_to_target"] = *summary.time_to_target;
  if (summary.distance) json["path"] = path_json(view.scenario(), summary);
  if (summary.waypoints) {
    json["waypoints"] = {{"wanted", summary.waypoints->wanted},
                         {"passed", summary.waypoints->times.size()},
                         {"times", summary.waypoints->times}};
  }
  json["collision"] = summary.collision;
  json["min_clearance"] = summary.min_clearance;
  json["unsafe_between"] = or_null(summary.unsafe_between);
  json["contact"] = {{"count", or_null(summary.contacts)},
                     {"first_time", or_null(summary.first_contact)}};
  json["cost"] = {{"closed_loop", summary.closed_loop_cost}};
  json["ocp_ms"] = timing_json(summary);
  json["deadline_misses"] = summary.deadline_misses;
  json["ocp"] = {{"iterations", {{"median", summary.iterations_median}}},
                 {"fallbacks", summary.fallbacks},
                 {"deadline_stops", summary.deadline_stops}};
  json["certificate"] = {{"next_step",
                          {{"max", summary.next_step_max},
                           {"mean", summary.next_step_mean},
                           {"sum", summary.next_step_sum}}},
                         {"horizon", {{"max", summary.horizon_max}}},
                         {"thesis", {{"max", summary.thesis_max}}}};
  json["certificate"].update(scope_json(summary.no_bound));
  json["believed"] = {{"next_step", believed_json(summary.believed)}};
  add_risk(summary.risk, json);
  json["mismatch"] = {{"one_step",
                       {{"rmse", vector_json(summary.mismatch_rmse)},
                        {"mean", vector_json(summary.mismatch_mean)},
                        {"covariance", rows_json(summary.mismatch_covariance)}}}};
  json["video"] = nullptr;
  if (!options.video_file.empty()) json["video"] = options.video_file;
  return json_text(json);
}

}  // namespace qsmpc::harness
