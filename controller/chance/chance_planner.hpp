// Plans that keep a chance constraint of the literature, in a receding horizon: the expected
// quadratic cost is minimised over inputs by a quasi-Newton method with bounds, the constraint kept
// by the augmented Lagrangian.
//
// Neither penalties nor certificates have a part in it: what a plan is believed to risk is the
// method's own opinion.
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
  PlannerSettings problem;  ///< of which penalties and limits of the risk are not used
  ChanceSettings chance{};
  std::string constraint = "cone";  ///< a name of `chance_constraints`
  /// Whether the input bounds are moved in by the deviations of the inputs that feedback makes, as
  /// many as a cone asks for: a tube about the path.
  bool tightened_inputs = false;
};

/// A plan, valid until the next one.
struct ChancePlan {
  Policy policy;
  CostParts cost;
  SolverStatus status = SolverStatus::kConverged;
  int evaluations = 0;
  double violation = 0.0;  ///< m, of the constraint that is violated most
  double believed =
      0.0;  ///< probability of being unsafe after the first stage, as the method has it
  PlanTiming timing;
};

class ChancePlanner {
 public:
  /// `dynamics` must outlive it. Throws std::invalid_argument on settings that make no sense, as
  /// Planner, and where a memory is asked of a constraint that has no samples.
  ChancePlanner(const models::Dynamics& dynamics, const ChancePlannerSettings& settings);
  ~ChancePlanner();
  ChancePlanner(const ChancePlanner&) = delete;
  ChancePlanner& operator=(const ChancePlanner&) = delete;
  ChancePlanner(ChancePlanner&&) = delete;
  ChancePlanner& operator=(ChancePlanner&&) = delete;

  /// A plan from `belief` in period `period` of a drive, going on from the last one. Time that is
  /// up is a status: the best so far then. progress: as in PlanRequest.
  const ChancePlan& plan(
      const Gaussian& belief, Eigen::Index period,
      std::chrono::steady_clock::time_point deadline = std::chrono::steady_clock::time_point::max(),
      std::optional<double> progress = {});
  /// The same for these paths instead of such as are drawn. Throws std::invalid_argument unless
  /// there are paths() of them, over the horizon.
  const ChancePlan& plan(const Gaussian& belief, PathDraw draw,
                         std::chrono::steady_clock::time_point deadline =
                             std::chrono::steady_clock::time_point::max());
  /// The next plan is the first of another drive, whose paths are drawn from this seed.
  void reset(std::uint64_t seed);

  /// How many paths are sampled for a plan; 0 where the constraint is on Gaussian laws.
  [[nodiscard]] Eigen::Index paths() const { return path_count_; }

 private:
  class Constraints;

  void draw(const Gaussian& belief, Eigen::Index period);
  const ChancePlan& make(const Gaussian& belief, std::chrono::steady_clock::time_point deadline);
  void move_on();
  void take_result(const Gaussian& belief);
  void place_target(const Gaussian& belief);
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
  QuadraticCost weights_;  // about the target that is nearest to the belief, or the guide's aim
  AugmentedLagrangian lagrangian_;
  ProjectedBfgsSolver solver_;
  OcpProblem problem_;
  Eigen::MatrixXd noise_root_;
  Eigen::MatrixXd belief_covariance_;  // that belief_root_ belongs to
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
  std::optional<double> progress_;  // of the plan at hand
  ChancePlan plan_;
};

}  // namespace qsmpc::controller

#pragma GCC visibility pop
