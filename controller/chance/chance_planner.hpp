// Receding-horizon plans under a chance constraint from the literature: a quasi-Newton method with
// bounds minimises the expected quadratic cost over the inputs, and an augmented Lagrangian
// enforces the constraint.
//
// Certificates play no part in it, and penalties only in the first guess: the risk that a plan
// reports is the method's own estimate.
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "controller/chance/chance_constraint.hpp"
#include "controller/chance/sampled_paths.hpp"
#include "controller/measure/measures.hpp"
#include "controller/planning/guide/guide.hpp"
#include "controller/planning/plan.hpp"
#include "controller/planning/planner.hpp"
#include "controller/planning/planner_settings.hpp"
#include "controller/planning/policy_maker.hpp"
#include "controller/planning/solvers/augmented_lagrangian.hpp"
#include "controller/planning/solvers/projected_bfgs_solver.hpp"
#include "models/dynamics/dynamics.hpp"

#pragma GCC visibility push(default)

namespace qsmpc::controller {

struct ChancePlannerSettings {
  PlannerSettings problem;  ///< penalties and risk limits are not used by the search
  ChanceSettings chance{};
  std::string constraint = "cone";  ///< a name of `chance_constraints`
  /// Whether the bounds of the nominal inputs are tightened by the standard deviations of the
  /// feedback inputs, times the factor of the cone: a tube about the path.
  bool tightened_inputs = false;
};

/// A plan, valid until the next one.
struct ChancePlan {
  Policy policy;
  CostParts cost;
  SolverStatus status = SolverStatus::kConverged;
  int evaluations = 0;
  double violation = 0.0;  ///< m, of the most violated constraint
  double believed =
      0.0;  ///< probability of being unsafe after the first stage, as the method estimates it
  PlanTiming timing;
};

class ChancePlanner {
 public:
  /// `dynamics` must outlive it. Throws std::invalid_argument on invalid settings, as Planner does,
  /// and on a memory for a constraint without samples.
  ChancePlanner(const models::Dynamics& dynamics, const ChancePlannerSettings& settings);
  ~ChancePlanner();
  ChancePlanner(const ChancePlanner&) = delete;
  ChancePlanner& operator=(const ChancePlanner&) = delete;
  ChancePlanner(ChancePlanner&&) = delete;
  ChancePlanner& operator=(ChancePlanner&&) = delete;

  /// A plan from `belief` in period `period` of a drive, warm-started from the last one. A missed
  /// deadline is a status; the plan is then the best so far. progress: as in PlanRequest.
  const ChancePlan& plan(
      const Gaussian& belief, Eigen::Index period,
      std::chrono::steady_clock::time_point deadline = std::chrono::steady_clock::time_point::max(),
      std::optional<double> progress = {});
  /// The same for given paths instead of randomly drawn ones. Throws std::invalid_argument unless
  /// there are paths() of them, over the horizon.
  const ChancePlan& plan(const Gaussian& belief, PathDraw draw,
                         std::chrono::steady_clock::time_point deadline =
                             std::chrono::steady_clock::time_point::max());
  /// The next plan is the first of another drive, whose paths are drawn from this seed.
  void reset(std::uint64_t seed);

  /// Number of paths sampled per plan; 0 where the constraint is on Gaussian laws.
  [[nodiscard]] Eigen::Index paths() const { return path_count_; }

 private:
  class Constraints;

  void draw(const Gaussian& belief, Eigen::Index period);
  const ChancePlan& make(const Gaussian& belief, std::chrono::steady_clock::time_point deadline);
  void move_on();
  void take_result(const Gaussian& belief);
  [[nodiscard]] bool first_guess(const Gaussian& belief,
                                 std::chrono::steady_clock::time_point deadline);
  void hold(const Gaussian& belief);
  void tighten();
  void search(const Gaussian& belief, bool warm, std::chrono::steady_clock::time_point deadline);
  [[nodiscard]] double violation_at(const Eigen::VectorXd& z);

  const models::Dynamics& dynamics_;
  ChancePlannerSettings settings_;
  UnsafeSet unsafe_;
  Eigen::Index path_count_;
  SampledPaths sampled_;
  std::unique_ptr<ChanceConstraint> constraint_;
  std::unique_ptr<Constraints> constraints_;
  std::optional<Planner> nominal_;  // of first guesses
  std::optional<Guide> guide_;
  PolicyMaker policies_;
  QuadraticCost weights_;  // about the target nearest to the belief, or the guide's aim
  AugmentedLagrangian lagrangian_;
  ProjectedBfgsSolver solver_;
  OcpProblem problem_;
  Eigen::MatrixXd noise_root_;
  Eigen::MatrixXd belief_covariance_;  // whose root is belief_root_
  Eigen::MatrixXd belief_root_;
  Eigen::MatrixXd normals_;  // scratch: state_dim x paths
  Eigen::MatrixXd inputs_;   // scratch: input_dim x horizon
  Eigen::MatrixXd a_;        // scratch of linearisations
  Eigen::MatrixXd b_;
  Eigen::MatrixXd moved_;
  std::vector<Eigen::MatrixXd> no_gains_;
  Eigen::MatrixXd no_change_;
  PathDraw draw_;
  std::vector<Eigen::MatrixXd> covariances_;
  Eigen::VectorXd z_;
  Eigen::VectorXd best_;
  Policy held_;  // whose gains are held
  std::uint64_t seed_ = 0;
  bool under_way_ = false;
  std::optional<double> progress_;  // of the current plan
  ChancePlan plan_;
};

}  // namespace qsmpc::controller

#pragma GCC visibility pop
