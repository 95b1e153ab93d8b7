// The probability of ever being unsafe in a drive, spent period by period.
//
// The certificate of the next stage, under the plan in force, is fixed before the state that it is
// about is known. If these certificates never add up to more than the budget, whatever happens, the
// probability that the drive is ever unsafe is at most the budget (docs/theory/certificates.md,
// section 6).
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
  /// limit: for the whole drive, infinite for none. target: the state that the drive ends at. Keeps
  /// a reference to `dynamics`.
  MissionBudget(const models::Dynamics& dynamics, double limit, const Eigen::VectorXd& target);

  /// Starts a new drive, with nothing spent.
  void reset();

  /// Limits of the plan for a belief with this mean. The next stage may use all that is left. The
  /// plan as a whole gets a share of it: the share of the remaining way to the target that it is
  /// expected to cover, raised because only part of what plans are certified for is ever spent, as
  /// late stages are replanned before they are driven. periods_left: an upper limit on the periods
  /// left in the drive. way: remaining way to the target, m, where it is known.
  [[nodiscard]] RiskLimits limits(const Eigen::VectorXd& mean, Eigen::Index horizon,
                                  Eigen::Index periods_left,
                                  std::optional<double> way = std::nullopt) const;

  /// The plan takes effect: the certificate of its next stage is spent.
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
  double planned_ = 0.0;   // what would be spent if plans were driven to their end
  double progress_ = 0.0;  // m per period, along the last plan
};

}  // namespace qsmpc::controller
