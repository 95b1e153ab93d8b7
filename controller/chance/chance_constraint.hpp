// Chance constraints of the literature: that the body is clear of the unsafe set with a stated
// probability, each in the way in which its method believes it. They say nothing of the true
// probability; certificates do (certification/certificate.hpp).
//
// A new one is a file with a class, and a line in the table.
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

/// What is held while inputs are searched for.
struct HeldLaws {
  /// Of the states at stage 0 … horizon as the linearised model has them, state_dim x state_dim.
  const std::vector<Eigen::MatrixXd>& covariances;
};

/// Constraints c ≤ 0 at the stages 1 … horizon, in metres.
class ChanceConstraint {
 public:
  virtual ~ChanceConstraint() = default;

  /// How many there are at a stage.
  [[nodiscard]] virtual Eigen::Index per_stage() const = 0;
  /// For the constraints on Gaussian laws: what their margins are from now on, about where `paths`
  /// are.
  virtual void hold(const HeldLaws& /*laws*/, const SampledPaths& /*paths*/) {}
  /// c at a stage; `values` comes with per_stage() entries.
  virtual void values(Eigen::Index stage, const SampledPaths& paths,
                      Eigen::Ref<Eigen::VectorXd> values) = 0;
  /// Adds Σ_j multipliers_j ∂c_j/∂states to the adjoint of the stage. At the states of which
  /// `values` has been asked last for the stage.
  virtual void add_adjoint(Eigen::Index stage, const Eigen::Ref<const Eigen::VectorXd>& multipliers,
                           SampledPaths& paths) = 0;
  /// The probability of being unsafe at `stage` that the method believes in. As add_adjoint.
  [[nodiscard]] virtual double believed(Eigen::Index stage, const SampledPaths& paths) const = 0;
};

/// What constraints are made for.
struct ChanceProblem {
  const UnsafeSet& unsafe;  ///< must outlive them
  const ChanceSettings& settings;
  Eigen::Index horizon = 1;
  Eigen::Index paths = 0;  ///< that are sampled; 0 for constraints on Gaussian laws
};

struct ChanceConstraintEntry {
  std::string name;
  std::string summary;
  bool samples = false;  ///< whether it is said of sampled paths; else of Gaussian laws
  std::unique_ptr<ChanceConstraint> (*make)(const ChanceProblem& problem) = nullptr;
};

/// The table: "cone", "cantelli", "scenario", "cvar", "drcc".
[[nodiscard]] const std::vector<ChanceConstraintEntry>& chance_constraints();

/// Throws std::invalid_argument on an unknown name.
[[nodiscard]] const ChanceConstraintEntry& chance_constraint_entry(std::string_view name);

// The makers of the table.
[[nodiscard]] std::unique_ptr<ChanceConstraint> make_cone_constraint(const ChanceProblem& problem);
[[nodiscard]] std::unique_ptr<ChanceConstraint> make_cantelli_constraint(
    const ChanceProblem& problem);
[[nodiscard]] std::unique_ptr<ChanceConstraint> make_scenario_constraint(
    const ChanceProblem& problem);
[[nodiscard]] std::unique_ptr<ChanceConstraint> make_cvar_constraint(const ChanceProblem& problem);
[[nodiscard]] std::unique_ptr<ChanceConstraint> make_drcc_constraint(const ChanceProblem& problem);

}  // namespace qsmpc::controller

#pragma GCC visibility pop
