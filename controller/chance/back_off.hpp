// Constraints on a Gaussian law: the noise-free path keeps as many standard deviations away from
// each region as a factor says.
//
// The obstacle is linearised: its surface is taken for the plane that is nearest to the path, along
// whose normal n the deviation is √(nᵀ Σ n). Both are held while inputs are searched for, so that
// the gradient is that of the path alone (the zero-order update of Zanelli, Frey, Messerer, Diehl:
// "Zero-order robust nonlinear model predictive control with ellipsoidal uncertainty sets", 2021).
#pragma once

#include <memory>
#include <vector>

#include <Eigen/Core>

#include "controller/chance/chance_constraint.hpp"

namespace qsmpc::controller {

class BackOffConstraint final : public ChanceConstraint {
 public:
  /// factor: standard deviations that are kept. beyond: the probability of being beyond a plane
  /// that is so many standard deviations away.
  BackOffConstraint(const ChanceProblem& problem, double factor, double (*beyond)(double));

  [[nodiscard]] Eigen::Index per_stage() const override {
    return static_cast<Eigen::Index>(regions_.size());
  }
  void hold(const HeldLaws& laws, const SampledPaths& paths) override;
  void values(Eigen::Index stage, const SampledPaths& paths,
              Eigen::Ref<Eigen::VectorXd> values) override;
  void add_adjoint(Eigen::Index stage, const Eigen::Ref<const Eigen::VectorXd>& multipliers,
                   SampledPaths& paths) override;
  [[nodiscard]] double believed(Eigen::Index stage, const SampledPaths& paths) const override;

 private:
  /// One region as one disc meets it.
  struct Meeting {
    const DiscView* disc;
    const UnsafeRegion* region;
  };

  void look(Eigen::Index stage, const SampledPaths& paths);

  double factor_;
  double (*beyond_)(double);
  std::vector<Meeting> regions_;
  Eigen::MatrixXd deviations_;  // of the distances; regions x horizon
  // At the stage looked at last, where it was then: by region.
  std::vector<Eigen::VectorXd> distances_;  // by stage: regions
  std::vector<Eigen::MatrixXd> slopes_;     // by stage: state_dim x regions
  Points state_;                            // scratch: state_dim x 1
  Points centre_;
  Points slope_;
  NearestFaces nearest_;
};

}  // namespace qsmpc::controller
