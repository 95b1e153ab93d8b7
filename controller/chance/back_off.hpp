// Constraints on a Gaussian law: the noise-free path keeps a distance of `factor` standard
// deviations from each region.
//
// The obstacle is linearised: its surface is replaced by the plane nearest to the path, along whose
// normal n the standard deviation is √(nᵀ Σ n). The deviations are held while the inputs are
// optimised, so that the gradient is only that of the distance (the zero-order update of Zanelli,
// Frey, Messerer, Diehl: "Zero-order robust nonlinear model predictive control with ellipsoidal
// uncertainty sets", 2021).
#pragma once

#include <memory>
#include <vector>

#include <Eigen/Core>

#include "controller/chance/chance_constraint.hpp"

namespace qsmpc::controller {

class BackOffConstraint final : public ChanceConstraint {
 public:
  /// factor: number of standard deviations to keep. beyond: the probability of being beyond a
  /// plane, as a function of its distance in standard deviations.
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
  /// A region paired with a disc.
  struct Meeting {
    const DiscView* disc;
    const UnsafeRegion* region;
  };

  void look(Eigen::Index stage, const SampledPaths& paths);

  double factor_;
  double (*beyond_)(double);
  std::vector<Meeting> regions_;
  Eigen::MatrixXd deviations_;  // of the distances; regions x horizon
  // At each stage, as of the last `look`, by region.
  std::vector<Eigen::VectorXd> distances_;  // by stage: regions
  std::vector<Eigen::MatrixXd> slopes_;     // by stage: state_dim x regions
  Points state_;                            // scratch: state_dim x 1
  Points centre_;
  Points slope_;
  NearestFaces nearest_;
};

}  // namespace qsmpc::controller
