// The clearances of sampled paths, stage by stage, with their derivatives.
#pragma once

#include <vector>

#include "controller/chance/sampled_paths.hpp"
#include "controller/regions/unsafe_set.hpp"

namespace qsmpc::controller {

class SampledClearances {
 public:
  /// Refers to the unsafe set.
  SampledClearances(const UnsafeSet& unsafe, Eigen::Index horizon)
      : unsafe_(unsafe), stages_(static_cast<std::size_t>(horizon)) {}

  /// Clearances (m) of the paths at a stage, 1 … horizon, where they are now; no more than 1e9.
  const Eigen::ArrayXd& look(Eigen::Index stage, const SampledPaths& paths);
  /// The same, as they were.
  [[nodiscard]] const Eigen::ArrayXd& at(Eigen::Index stage) const {
    return stages_[stage - 1].distance;
  }
  /// Adds −Σ_i multipliers_i ∂clearance_i/∂states to the adjoint of the stage.
  template <class Multipliers>
  void subtract(Eigen::Index stage, const Multipliers& multipliers, SampledPaths& paths) const {
    const Points& slope = stages_[stage - 1].slope;
    Points& adjoint = paths.adjoint(stage);
    for (Eigen::Index i = 0; i < slope.cols(); ++i) {
      if (multipliers[i] != 0.0) adjoint.col(i) -= multipliers[i] * slope.col(i);
    }
  }
  /// The share of paths that are unsafe at a stage.
  [[nodiscard]] double unsafe_share(Eigen::Index stage) const {
    return (at(stage) <= 0.0).cast<double>().mean();
  }

 private:
  const UnsafeSet& unsafe_;
  std::vector<NearestFaces> stages_;
  Points states_;
  ClearanceScratch scratch_;
};

}  // namespace qsmpc::controller
