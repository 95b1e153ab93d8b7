// The probability of ever being unsafe in a drive, spent period by period.
//
// The certificate of the next stage, of the plan in force, is fixed before the state is known that
// it is about. If these certificates never add up to more than the budget, whatever happens, the
// drive is ever unsafe with at most that probability (docs/theory/certificates.md, section 6).
#pragma once

#include <limits>
#include <optional>

#include <Eigen/Core>

#include "controller/planning/plan.hpp"
#include "controller/planning/risk/risk_limits.hpp"
#include "models/dynamics/dynamics.hpp"

namespace qsmpc::controller {

class MissionBudget {
 public:
  /// limit: of the whole drive, infinite for none. target: the state that the drive is to. Refers
  /// to the system.
  MissionBudget(const models::Dynamics& dynamics, double limit, const Eigen::VectorXd& target);

  /// A new drive: nothing is spent.
  void reset();

  /// Limits of the plan for a belief with this mean: the next stage may use all that is left, and
  /// the plan its share of it, by how much of the way to the target it is expected to come, and by
  /// how much of what plans are certified is spent in the end: late stages are planned anew before
  /// they are driven. periods_left: of the drive, at most. way: to the target, m, where it is
  /// known.
  [[nodiscard]] RiskLimits limits(const Eigen::VectorXd& mean, Eigen::Index horizon,
                                  Eigen::Index periods_left,
                                  std::optional<double> way = std::nullopt) const;

  /// The plan is in force: what is certified of its next stage is spent.
  void spend(const Plan& plan);

  [[nodiscard]] double limit() const { return limit_; }
  [[nodiscard]] double spent() const { return spent_; }

 private:
  [[nodiscard]] double spent_of_planned() const;
  [[nodiscard]] double expected_periods(const Eigen::VectorXd& mean,
                                        std::optional<double> way) const;

  const models::Dynamics& dynamics_;
  double limit_;
  Eigen::VectorXd target_;
  double spent_ = 0.0;
  double planned_ = 0.0;   // what would be spent if plans were driven to their ends
  double progress_ = 0.0;  // m a period, along the last plan
};

}  // namespace qsmpc::controller
