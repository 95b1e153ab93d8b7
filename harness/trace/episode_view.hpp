// An episode as those see it who show or count it: what its trace says, worked out once.
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
  /// Throws std::invalid_argument on a trace that is not whole, which no reader returns.
  explicit EpisodeView(const Trace& trace);

  [[nodiscard]] const Trace& trace() const { return trace_; }
  [[nodiscard]] const Scenario& scenario() const { return trace_.scenario; }
  [[nodiscard]] const models::SystemDescription& system() const { return trace_.system; }
  /// What the controller's decisions have.
  [[nodiscard]] const controller::DecisionParts& parts() const { return parts_; }
  [[nodiscard]] const Summary& summary() const { return summary_; }

  /// s, from the start to the end of the last control period; 0 without steps.
  [[nodiscard]] double duration() const { return duration_; }
  /// The true states at the control instants: state_dim x (steps + 1), or as many columns as there
  /// are steps where the state after the last one is not known.
  [[nodiscard]] const Eigen::MatrixXd& states() const { return states_; }
  /// The unit of distances to the unsafe set: that of the states which the safe set restricts, or
  /// "state units" where they differ.
  [[nodiscard]] const std::string& clearance_unit() const { return clearance_unit_; }
  /// Of each of these states from the unsafe set.
  [[nodiscard]] const Eigen::VectorXd& clearances() const { return clearances_; }
  /// s, of the first of these states that is unsafe; none where all are safe.
  [[nodiscard]] std::optional<double> first_unsafe_time() const;
  /// How many periods the plant came through: those of which the state at the end is a result.
  [[nodiscard]] Eigen::Index periods() const { return residuals_.cols(); }
  /// Whether the true state at the end of period k < periods() is unsafe.
  [[nodiscard]] bool ended_unsafe(Eigen::Index k) const { return clearances_[k + 1] <= 0.0; }
  /// x_{k+1} − w_k − f(x_k, u_k) of each of these periods, state_dim x periods.
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
