// Inequality constraints on the particles of a stage. A constraint is a class, and a line in the
// table below.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "controller/measure/measures.hpp"
#include "controller/planning/cost/stage_slope.hpp"
#include "controller/regions/safe_set.hpp"

namespace qsmpc::controller {

/// Constraints c ≤ 0, in groups of similar members: among the violated ones of a group, a solver
/// considers the worst first. Every function takes the stage, 1 … horizon, and its particles
/// (state_dim x n).
class StageConstraint {
 public:
  virtual ~StageConstraint() = default;

  [[nodiscard]] virtual int groups() const = 0;
  /// Number of constraints in a group, at a stage of `particles` particles.
  [[nodiscard]] virtual Eigen::Index group_size(Eigen::Index particles) const = 0;
  /// c of a group, in the unit of the constraint; `values` comes with group_size entries.
  virtual void values(Eigen::Index stage, int group, const Points& particles,
                      Eigen::Ref<Eigen::VectorXd> values) const = 0;
  /// c of one member of a group; overwrites `slope` with its derivative.
  [[nodiscard]] virtual double value_and_slope(Eigen::Index stage, int group,
                                               const Points& particles, Eigen::Index index,
                                               StageSlope& slope) const = 0;
};

struct StageConstraintEntry {
  std::string name;
  std::string summary;
  /// nullptr where the problem has no such constraint.
  std::unique_ptr<const StageConstraint> (*make)(const SafeSet& safe_set) = nullptr;
};

/// The table of constraints. A solver that supports constraints enforces all of them.
[[nodiscard]] const std::vector<StageConstraintEntry>& stage_constraints();

// The factories in the table.
[[nodiscard]] std::unique_ptr<const StageConstraint> make_bounds_constraint(
    const SafeSet& safe_set);

}  // namespace qsmpc::controller
