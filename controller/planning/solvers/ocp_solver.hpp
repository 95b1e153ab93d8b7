// Solvers of the optimal control problem: minimise a piecewise smooth function of a flat vector z
// over a box, and for those that can, under inequality constraints.
//
//   const std::unique_ptr<OcpSolver> solver = make_solver("lbfgs", {.bounding = "bounded"});
//   const SolverResult& result = solver->minimise(problem, start, {.max_evaluations = 50});
//
// A solver owns its scratch. Quasi-Newton solvers keep the curvature of the last problem for the
// next; `forget` discards and `shift` moves it.
#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "controller/planning/solvers/solver_status.hpp"

namespace qsmpc::controller {

/// Value at `z` (n); overwrites the gradient, which comes with n entries.
using CostFunction = std::function<double(const Eigen::VectorXd& z, Eigen::VectorXd& gradient)>;

/// Inequality constraints c_j(z) ≤ 0, possibly far more than a solver could handle at once (Eq.
/// 4-8: each particle at each stage against each face). A solver asks for all values, but only for
/// the gradients of the few that matter.
struct ConstraintSet {
  Eigen::Index count = 0;
  /// All of them; `values` comes with `count` entries.
  std::function<void(const Eigen::VectorXd& z, Eigen::VectorXd& values)> values;
  /// Only those in `which`: `values` comes with which.size() entries, `gradients` as n x
  /// which.size().
  std::function<void(const Eigen::VectorXd& z, const std::vector<int>& which,
                     Eigen::VectorXd& values, Eigen::MatrixXd& gradients)>
      some;
  /// `count` numbers ≥ 0, or empty: constraints of one group are similar (one face at one stage),
  /// and the worst violated one is considered first. Empty: each is its own group.
  std::vector<int> group;
};

struct OcpProblem {
  CostFunction cost;
  Eigen::VectorXd lower;  ///< n, entries may be -infinity
  Eigen::VectorXd upper;  ///< n, ≥ lower, entries may be infinity
  std::optional<ConstraintSet> constraints;
};

struct SolverOptions {
  int max_evaluations = 100;         ///< of cost and gradient, ≥ 1
  double relative_tolerance = 1e-8;  ///< stop when the relative decrease is smaller
  /// No evaluation starts after it.
  std::chrono::steady_clock::time_point deadline = std::chrono::steady_clock::time_point::max();
  double constraint_tolerance = 1e-6;  ///< a constraint counts as kept up to this value
};

struct SolverResult {
  Eigen::VectorXd z;   ///< best found, within the bounds
  double value = 0.0;  ///< cost there; not finite if no finite value was seen
  int evaluations = 0;
  SolverStatus status = SolverStatus::kConverged;
  double violation = 0.0;  ///< largest max(c_j(z), 0); zero without constraints
};

/// The layout of a decision vector: inputs_per_stage · horizon entries stage by stage, possibly
/// followed by others that belong to no stage.
struct StageLayout {
  Eigen::Index inputs_per_stage = 1;
  Eigen::Index horizon = 1;
};

class OcpSolver {
 public:
  virtual ~OcpSolver() = default;
  /// Minimises from `start` (n), which is moved to the bounds if it lies beyond. The result is
  /// valid until the next call. Throws std::invalid_argument on mismatched sizes, on bounds that
  /// are crossed or NaN, and on constraints given to a solver that takes none. Exceptions of the
  /// problem's functions pass through. Never throws for numerical reasons.
  virtual const SolverResult& minimise(const OcpProblem& problem, const Eigen::VectorXd& start,
                                       const SolverOptions& options) = 0;
  /// The next call is a cold start.
  virtual void forget() {}
  /// The decision vector moves on by one stage: the inputs of the first stage drop out, the others
  /// move up, and a new last stage is added. The curvature estimate is shifted with them.
  virtual void shift(const StageLayout& /*layout*/) {}
};

struct SolverSettings {
  std::string bounding = "bounded";  ///< a name of `input_boundings`
};

/// One solver. A new one is a file with a class, and a line in the table.
struct SolverEntry {
  std::string name;
  std::string summary;
  std::unique_ptr<OcpSolver> (*make)(const SolverSettings& settings) = nullptr;
  bool takes_constraints = false;  ///< whether it supports inequality constraints
  bool chooses_bounding = false;   ///< whether `SolverSettings::bounding` applies
};

/// The table of solvers.
[[nodiscard]] const std::vector<SolverEntry>& solvers();

/// Throws std::invalid_argument on an unknown name.
[[nodiscard]] const SolverEntry& solver_entry(std::string_view name);

struct InputBoundingEntry {
  std::string name;
  std::string summary;
};

/// The table of ways to keep the bounds, for solvers with that choice.
[[nodiscard]] const std::vector<InputBoundingEntry>& input_boundings();

/// Throws std::invalid_argument on an unknown name.
[[nodiscard]] std::unique_ptr<OcpSolver> make_solver(std::string_view name,
                                                     const SolverSettings& settings = {});

enum class ConstraintsTaken { kNone, kInequalities };

/// The checks that every solver makes first; throws std::invalid_argument as for
/// `OcpSolver::minimise`.
void check_problem(const OcpProblem& problem, const Eigen::VectorXd& start,
                   const SolverOptions& options, ConstraintsTaken taken);

}  // namespace qsmpc::controller
