// The clearances of sampled paths, stage by stage, with their derivatives.
#pragma once

#include <vector>

#include "controller/chance/sampled_paths.hpp"
#include "controller/regions/unsafe_set.hpp"

namespace qsmpc::controller {

class SampledClearances {
 public:
  /// Keeps a reference to the unsafe set.
  SampledClearances(const UnsafeSet& unsafe, Eigen::Index horizon)
      : unsafe_(unsafe), stages_(static_cast<std::size_t>(horizon)) {}

  /// Computes the clearances (m) of the paths at a stage, 1 … horizon, at their present states;
  /// capped at 1e9.
  const Eigen::ArrayXd& look(Eigen::Index stage, const SampledPaths& paths);
  /// The clearances that `look` last computed for the stage.
  [[nodiscard]] const Eigen::ArrayXd& at(Eigen::Index stage) const { return stages_[stage - 1]; }
  /// Adds −Σ_i multipliers_i ∂clearance_i/∂states to the adjoint of the stage. The paths must be
  /// unchanged since `look`.
  template <class Multipliers>
  void subtract(Eigen::Index stage, const Multipliers& multipliers, SampledPaths& paths) {
    Points& adjoint = paths.adjoint(stage);
    for (Eigen::Index i = 0; i < paths.paths(); ++i) {
      // Most multipliers are zero: few paths are near the unsafe set.
      if (multipliers[i] != 0.0) adjoint.col(i) -= multipliers[i] * slope(stage, paths, i);
    }
  }
  /// The share of paths that are unsafe at a stage.
  [[nodiscard]] double unsafe_share(Eigen::Index stage) const {
    return (at(stage) <= 0.0).cast<double>().mean();
  }

 private:
  void turn(const DiscPlacement& placement);
  [[nodiscard]] Points::ConstColXpr slope(Eigen::Index stage, const SampledPaths& paths,
                                          Eigen::Index path);

  const UnsafeSet& unsafe_;
  std::vector<Eigen::ArrayXd> stages_;
  // Scratch of `look`.
  Points states_;
  Points centres_;
  Eigen::ArrayXd cosines_;  // of heading + bearing, for the disc placed last
  Eigen::ArrayXd sines_;
  // Scratch of `slope`.
  Points one_;  // of the states
  NearestFaces nearest_;
  ClearanceScratch scratch_;
};

}  // namespace qsmpc::controller
