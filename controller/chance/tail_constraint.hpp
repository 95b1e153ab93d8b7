// Constraints on the tail of the sampled clearances, one for each stage.
#pragma once

#include <vector>

#include "controller/chance/chance_constraint.hpp"
#include "controller/chance/sampled_clearances.hpp"
#include "controller/chance/smoothed_tail.hpp"

namespace qsmpc::controller {

/// The conditional value at risk of minus the clearance, plus an allowance (m), is at most 0.
class TailConstraint final : public ChanceConstraint {
 public:
  TailConstraint(const ChanceProblem& problem, double allowance)
      : risk_(problem.settings.risk),
        smoothing_(problem.settings.smoothing),
        allowance_(allowance),
        clearances_(problem.unsafe, problem.horizon),
        tails_(static_cast<std::size_t>(problem.horizon)) {}

  [[nodiscard]] Eigen::Index per_stage() const override { return 1; }

  void values(Eigen::Index stage, const SampledPaths& paths,
              Eigen::Ref<Eigen::VectorXd> values) override {
    losses_ = -clearances_.look(stage, paths);
    values[0] = smoothed_cvar(losses_, risk_, smoothing_, tails_[stage - 1]) + allowance_;
  }

  void add_adjoint(Eigen::Index stage, const Eigen::Ref<const Eigen::VectorXd>& multipliers,
                   SampledPaths& paths) override {
    if (multipliers[0] == 0.0) return;
    clearances_.subtract(stage, multipliers[0] * tails_[stage - 1], paths);
  }

  [[nodiscard]] double believed(Eigen::Index stage, const SampledPaths& /*paths*/) const override {
    return clearances_.unsafe_share(stage);
  }

 private:
  double risk_;
  double smoothing_;
  double allowance_;
  SampledClearances clearances_;
  std::vector<Eigen::ArrayXd> tails_;  // by stage: the derivative by the losses
  Eigen::ArrayXd losses_;
};

}  // namespace qsmpc::controller
