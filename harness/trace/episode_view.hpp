// An episode prepared for display and statistics: quantities derived from its trace, computed once.
//
//   const Trace trace = read_trace("out/episode.h5");
//   const EpisodeView view(trace);
//   view.summary().outcome;
#pragma once

#include <optional>
#include <string>

#include <Eigen/Core>

#include "controller/control/controller.hpp"
#include "harness/trace/summary.hpp"
#include "harness/trace/trace.hpp"
#include "models/dynamics/dynamics.hpp"

#pragma GCC visibility push(default)

namespace qsmpc::harness {

/// Refers to the trace, which must outlive it.
class EpisodeView {
 public:
  /// Throws std::invalid_argument on an incomplete trace, which no reader returns.
  explicit EpisodeView(const Trace& trace);

  [[nodiscard]] const Trace& trace() const { return trace_; }
  [[nodiscard]] const Scenario& scenario() const { return trace_.scenario; }
  [[nodiscard]] const models::SystemDescription& system() const { return trace_.system; }
  /// Which parts the controller's decisions have.
  [[nodiscard]] const controller::DecisionParts& parts() const { return parts_; }
  [[nodiscard]] const Summary& summary() const { return summary_; }

  /// Time from the start to the end of the last control period, s; 0 without steps.
  [[nodiscard]] double duration() const { return duration_; }
  /// The true states at the control instants: state_dim x (steps + 1), or state_dim x steps if the
  /// state after the last step is not known.
  [[nodiscard]] const Eigen::MatrixXd& states() const { return states_; }
  /// The unit of distances to the unsafe set: that of the states restricted by the safe set, or
  /// "state units" if their units differ.
  [[nodiscard]] const std::string& clearance_unit() const { return clearance_unit_; }
  /// The distance of each of these states to the unsafe set.
  [[nodiscard]] const Eigen::VectorXd& clearances() const { return clearances_; }
  /// Time of the first unsafe one of these states, s; nothing if all are safe.
  [[nodiscard]] std::optional<double> first_unsafe_time() const;
  /// How many periods the plant completed, so that the state at their end is a result of the plant.
  [[nodiscard]] Eigen::Index periods() const { return residuals_.cols(); }
  /// Whether the true state at the end of period k < periods() is unsafe.
  [[nodiscard]] bool ended_unsafe(Eigen::Index k) const { return clearances_[k + 1] <= 0.0; }
  /// x_{k+1} − w_k − f(x_k, u_k) for each of these periods, state_dim x periods.
  [[nodiscard]] const Eigen::MatrixXd& residuals() const { return residuals_; }

 private:
  const Trace& trace_;
  controller::DecisionParts parts_;
  double duration_ = 0.0;
  std::string clearance_unit_;
  Eigen::MatrixXd states_;
  Eigen::VectorXd clearances_;
  Eigen::MatrixXd residuals_;
  Summary summary_;
};

}  // namespace qsmpc::harness

#pragma GCC visibility pop
