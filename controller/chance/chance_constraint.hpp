// Chance constraints from the literature: the body is clear of the unsafe set with a stated
// probability, as each method approximates it. They say nothing about the true probability;
// certificates do (certification/certificate.hpp).
//
// To add one, write a file with a class, and add a line to the table.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "controller/chance/chance_settings.hpp"
#include "controller/chance/sampled_paths.hpp"
#include "controller/regions/unsafe_set.hpp"

#pragma GCC visibility push(default)

namespace qsmpc::controller {

/// What is held fixed while the inputs are optimised.
struct HeldLaws {
  /// Of the states at stage 0 … horizon in the linearised model, state_dim x state_dim.
  const std::vector<Eigen::MatrixXd>& covariances;
};

/// Constraints c ≤ 0 at the stages 1 … horizon, in metres.
class ChanceConstraint {
 public:
  virtual ~ChanceConstraint() = default;

  /// Number of constraints at a stage.
  [[nodiscard]] virtual Eigen::Index per_stage() const = 0;
  /// For constraints on Gaussian laws: fixes their margins, linearised about the present `paths`.
  virtual void hold(const HeldLaws& /*laws*/, const SampledPaths& /*paths*/) {}
  /// c at a stage; `values` comes with per_stage() entries.
  virtual void values(Eigen::Index stage, const SampledPaths& paths,
                      Eigen::Ref<Eigen::VectorXd> values) = 0;
  /// Adds Σ_j multipliers_j ∂c_j/∂states to the adjoint of the stage. Evaluated at the states of
  /// the last call of `values` for the stage.
  virtual void add_adjoint(Eigen::Index stage, const Eigen::Ref<const Eigen::VectorXd>& multipliers,
                           SampledPaths& paths) = 0;
  /// The method's own estimate of the probability of being unsafe at `stage`, at the states as for
  /// add_adjoint.
  [[nodiscard]] virtual double believed(Eigen::Index stage, const SampledPaths& paths) const = 0;
};

/// What constraints are made for.
struct ChanceProblem {
  const UnsafeSet& unsafe;  ///< must outlive them
  const ChanceSettings& settings;
  Eigen::Index horizon = 1;
  Eigen::Index paths = 0;  ///< sampled paths; 0 for constraints on Gaussian laws
};

struct ChanceConstraintEntry {
  std::string name;
  std::string summary;
  bool samples = false;  ///< whether it is on sampled paths; else on Gaussian laws
  std::unique_ptr<ChanceConstraint> (*make)(const ChanceProblem& problem) = nullptr;
};

/// The table: "cone", "cantelli", "scenario", "cvar", "drcc".
[[nodiscard]] const std::vector<ChanceConstraintEntry>& chance_constraints();

/// Throws std::invalid_argument on an unknown name.
[[nodiscard]] const ChanceConstraintEntry& chance_constraint_entry(std::string_view name);

// The factories in the table.
[[nodiscard]] std::unique_ptr<ChanceConstraint> make_cone_constraint(const ChanceProblem& problem);
[[nodiscard]] std::unique_ptr<ChanceConstraint> make_cantelli_constraint(
    const ChanceProblem& problem);
[[nodiscard]] std::unique_ptr<ChanceConstraint> make_scenario_constraint(
    const ChanceProblem& problem);
[[nodiscard]] std::unique_ptr<ChanceConstraint> make_cvar_constraint(const ChanceProblem& problem);
[[nodiscard]] std::unique_ptr<ChanceConstraint> make_drcc_constraint(const ChanceProblem& problem);

}  // namespace qsmpc::controller

#pragma GCC visibility pop
