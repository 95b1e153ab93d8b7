// The performance figures of an episode, computed from its trace alone.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include <Eigen/Core>

#include "harness/statistics/quantiles.hpp"
#include "harness/trace/risk_use.hpp"
#include "harness/trace/target_progress.hpp"
#include "harness/trace/trace.hpp"

#pragma GCC visibility push(default)

namespace qsmpc::harness {

/// A controller's own estimates of the probability that the next state is unsafe, over the periods
/// of a drive. Not a bound.
struct BelievedRisk {
  double max = 0.0;
  double mean = 0.0;
  double sum = 0.0;
};

struct Summary {
  std::string scenario;
  std::uint64_t seed = 0;
  std::string version;
  std::string controller;  ///< its kind
  std::string estimator;   ///< its kind
  std::string outcome;
  std::string fault;     ///< the fault's message; empty without a fault
  std::string fault_of;  ///< "plant" or "controller"; empty without a fault
  int steps = 0;
  std::optional<double> time_to_target;    ///< s; also for a drive that was unsafe on its way
  std::optional<double> distance;          ///< m, along the path; nothing without one
  std::optional<Laps> laps;                ///< on a closed path
  std::optional<WaypointTimes> waypoints;  ///< nothing without waypoints
  bool collision = false;                  ///< the true state entered the unsafe set
  double min_clearance = 0.0;              ///< m, over all true states at the control instants
  /// Whether the true state was unsafe at a simulator step between the control instants, before the
  /// disturbance; nothing if no such state is known.
  std::optional<bool> unsafe_between;
  /// How often the vehicle touched solid walls and obstacles; nothing if they are not solid.
  std::optional<int> contacts;
  std::optional<double> first_contact;  ///< s
  double largest_contact = 0.0;         ///< N
  double closed_loop_cost = 0.0;        ///< Σ ½ |x − r|²_Q + |u|²_R along the true states
  Distribution ocp_ms;             ///< wall-clock time of a step: quantise … certify; 0 without
                                   ///< steps
  StepTiming breakdown;            ///< medians of the parts, ms
  int deadline_misses = 0;         ///< steps whose wall-clock time exceeded the control period
  double iterations_median = 0.0;  ///< evaluations of cost and gradient
  int fallbacks = 0;
  int deadline_stops = 0;  ///< plans that `controller.deadline` cut short
  /// Why certificates are not bounds, see why_no_bound; empty if they are.
  std::string no_bound;
  double next_step_max = 0.0;  ///< of the certificates of stage 1
  double next_step_mean = 0.0;
  double next_step_sum = 0.0;  ///< along the drive
  double horizon_max = 0.0;    ///< of the plans' sums over their stages; NaN without plans
  double thesis_max = 0.0;     ///< of the published value; not a bound
  /// Nothing if the controller has no estimate in some period, or there are no periods.
  std::optional<BelievedRisk> believed;
  RiskUse risk;  ///< the same certificates, against the scenario's limits
  /// One-step residual x_{k+1} − w_k − f(x_k, u_k) of the plant against the model, by state.
  Eigen::VectorXd mismatch_rmse;
  Eigen::VectorXd mismatch_mean;
  Eigen::MatrixXd mismatch_covariance;
};

/// ½ |x − r|²_Q + |u|²_R for a period that begins in `state` (state_dim) with `input` (input_dim):
/// the terms of the closed-loop cost. On a path, r is the reference at the path's nearest point;
/// with waypoints, it is the next one after `progress` of them.
[[nodiscard]] double period_cost(const Scenario& scenario, const Eigen::VectorXd& state,
                                 const Eigen::VectorXd& input, std::optional<double> progress = {});

class EpisodeView;

/// Computed from the view's other members; pages and files use view.summary().
[[nodiscard]] Summary summarise(const EpisodeView& view);

struct SummaryOptions {
  std::string video_file{};  ///< in the folder of the summary; empty: none
};

/// `summary.json`: stable keys, one object, ending in a new line. Numbers that are not finite are
/// null.
[[nodiscard]] std::string summary_json(const EpisodeView& view, const SummaryOptions& options = {});

}  // namespace qsmpc::harness

#pragma GCC visibility pop
