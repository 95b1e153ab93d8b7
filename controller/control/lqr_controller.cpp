// The linear-quadratic regulator: quadratic costs, linearised dynamics, inputs clamped to their
// bounds; it ignores obstacles and noise.
//
// About the target it is u = sat(K (x − r)) with the gain that the Riccati recursion at (r, 0)
// converges to. About the path it optimises the noise-free path over the horizon by iterative LQR
// (Li and Todorov 2004), warm-started from the last period's inputs, and regulates about it with
// the time-varying gains.
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "controller/control/controller.hpp"
#include "controller/control/controller_entries.hpp"
#include "controller/control/path_cost.hpp"
#include "controller/planning/cost/angular_target.hpp"
#include "controller/planning/cost/placed_target.hpp"
#include "controller/planning/start/first_guess.hpp"
#include "models/constants.hpp"

namespace qsmpc::controller {
namespace {

using Clock = std::chrono::steady_clock;

// The sweeps stop when one reduces the cost by less than this, relatively.
constexpr double kSweepSettled = 1e-6;
// How often a step that does not reduce the cost is halved.
constexpr int kHalvings = 8;
// The Riccati recursion about the target has converged when the gain changes by less, relatively …
constexpr double kGainSettled = 1e-10;
// … and is cut off after this many stages if it never does.
constexpr int kLongestRecursion = 5000;

/// The stage cost ½ xᵀQx + uᵀRu and the terminal cost xᵀPx have the Hessians Q, 2R and 2P.
LqrWeights curvature_of(const QuadraticCost& cost) {
  return {.state = cost.state, .input = 2.0 * cost.input, .terminal = 2.0 * cost.terminal};
}

/// u = sat(u_0 + K (y − r)).
class TargetRegulator final : public Controller {
 public:
  TargetRegulator(const models::Dynamics& dynamics, const PlannerSettings& problem)
      : problem_(problem), rest_(resting_input(problem.bounds)), gain_(settled_gain(dynamics)) {
    if (problem.path) throw std::invalid_argument("lqr: about the target it cannot follow a path");
    if (!gain_.allFinite()) {
      throw std::invalid_argument("lqr: the model has no finite linearisation at the target");
    }
  }

  const Decision& decide(const Situation& situation) override {
    check_situation(situation, gain_.cols());
    nearest_target(problem_.cost.target, problem_.cost.angles, situation.observation, nearest_);
    offset_ = situation.observation - nearest_;
    decision_.input = rest_;
    decision_.input.noalias() += gain_ * offset_;
    clamp_inputs(problem_.bounds, decision_.input);
    return decision_;
  }

 private:
  /// The first gain of a horizon that is doubled until it no longer changes.
  [[nodiscard]] Eigen::MatrixXd settled_gain(const models::Dynamics& dynamics) const {
    Eigen::MatrixXd gain;
    for (int stages = std::max(problem_.horizon, 2); stages <= kLongestRecursion; stages *= 2) {
      const Eigen::MatrixXd next =
          lqr_gains(dynamics, problem_.cost.target.replicate(1, stages + 1),
                    rest_.replicate(1, stages), curvature_of(problem_.cost))
              .front();
      const bool settled =
          gain.size() != 0 && (next - gain).norm() <= kGainSettled * (1.0 + next.norm());
      gain = next;
      if (settled || !gain.allFinite()) break;
    }
    return gain;
  }

  PlannerSettings problem_;
  Eigen::VectorXd rest_;
  Eigen::MatrixXd gain_;
  Eigen::VectorXd nearest_;  // the target modulo 2π, nearest to the observation
  Eigen::VectorXd offset_;
  Decision decision_;
};

/// Regulates about a path that it optimises in every period.
class PathRegulator final : public Controller {
 public:
  PathRegulator(const models::Dynamics& dynamics, const PlannerSettings& problem)
      : dynamics_(dynamics),
        problem_(problem),
        weights_(curvature_of(problem.cost)),
        cost_about_(problem.cost) {
    policy_.bounds = problem.bounds;
    trial_.bounds = problem.bounds;
    reset(0);
  }

  const Decision& decide(const Situation& situation) override;

  using Controller::reset;
  void reset(std::uint64_t /*seed*/) override {
    policy_.inputs = resting_input(problem_.bounds).replicate(1, problem_.horizon);
    under_way_ = false;
  }

 private:
  [[nodiscard]] CostParts cost_of(const Policy& path) {
    return path_cost(path, cost_about_, cost_scratch_);
  }
  /// Scratch of the sweeps; reused, only the first period allocates.
  struct Sweep {
    Eigen::MatrixXd a;
    Eigen::MatrixXd b;
    Eigen::MatrixXd value;  // of the cost-to-go: its Hessian …
    Eigen::VectorXd slope;  // … and its gradient on the path
    Eigen::MatrixXd value_b;
    Eigen::MatrixXd curvature;  // by the input
    Eigen::LDLT<Eigen::MatrixXd> ldlt;
    Eigen::VectorXd by_input;
    Eigen::VectorXd step;
    Eigen::VectorXd away;
    Eigen::VectorXd next_slope;
    Eigen::MatrixXd cross;
    Eigen::MatrixXd closed;
    Eigen::MatrixXd product;
    Eigen::MatrixXd weighted;
  };

  void linearise();
  [[nodiscard]] bool improve(int& evaluations);

  const models::Dynamics& dynamics_;
  PlannerSettings problem_;
  LqrWeights weights_;
  QuadraticCost cost_about_;  // about the target nearest to the belief
  bool under_way_ = false;    // whether the inputs come from the last period
  Policy policy_;
  CostParts cost_;
  Policy trial_;
  Eigen::MatrixXd steps_;  // input_dim x horizon: feedforward steps of a sweep
  LqrScratch scratch_;
  Sweep sweep_;
  PathCostScratch cost_scratch_;
  Decision decision_;
};

/// The backward sweep about the path: gains and feedforward steps.
void PathRegulator::linearise() {
  const Eigen::Index dim = policy_.states.rows();
  const Eigen::Index inputs = policy_.inputs.rows();
  Sweep& s = sweep_;
  s.a.resize(dim, dim);
  s.b.resize(dim, inputs);
  s.value = weights_.terminal;
  s.away = policy_.states.rightCols<1>() - cost_about_.target_at(policy_.horizon());
  s.slope.noalias() = weights_.terminal * s.away;
  policy_.gains.resize(static_cast<std::size_t>(policy_.horizon()));
  steps_.resize(inputs, policy_.horizon());
  for (Eigen::Index k = policy_.horizon() - 1; k >= 0; --k) {
    dynamics_.jacobians(policy_.states.col(k), policy_.inputs.col(k), s.a, s.b);
    s.value_b.noalias() = s.value * s.b;
    s.curvature = weights_.input;
    s.curvature.noalias() += s.b.transpose() * s.value_b;
    s.ldlt.compute(s.curvature);
    s.by_input.noalias() = weights_.input * policy_.inputs.col(k);
    s.by_input.noalias() += s.b.transpose() * s.slope;
    Eigen::MatrixXd& gain = policy_.gains[static_cast<std::size_t>(k)];
    gain.noalias() = s.value_b.transpose() * s.a;
    s.ldlt.solveInPlace(gain);
    gain *= -1.0;
    s.step = s.by_input;
    s.ldlt.solveInPlace(s.step);
    steps_.col(k) = -s.step;
    s.away = policy_.states.col(k) - cost_about_.target_at(k);
    s.next_slope.noalias() = weights_.state * s.away;
    s.next_slope.noalias() += s.a.transpose() * s.slope;
    s.next_slope.noalias() += gain.transpose() * s.by_input;
    s.cross.noalias() = s.a.transpose() * s.value_b;
    s.cross.noalias() += gain.transpose() * s.curvature;
    s.next_slope.noalias() += s.cross * steps_.col(k);
    s.slope.swap(s.next_slope);
    s.closed = s.a;
    s.closed.noalias() += s.b * gain;
    s.product.noalias() = s.value * s.closed;
    s.value = weights_.state;
    s.value.noalias() += s.closed.transpose() * s.product;
    s.weighted.noalias() = weights_.input * gain;
    s.value.noalias() += gain.transpose() * s.weighted;
  }
}

/// Backtracking line search: takes the longest halved step that reduces the cost. Returns whether
/// there is one.
bool PathRegulator::improve(int& evaluations) {
  using View = Eigen::Map<const models::StateBatch>;
  const Eigen::Index dim = policy_.states.rows();
  double share = 1.0;
  for (int n = 0; n <= kHalvings; ++n, share *= 0.5) {
    trial_.inputs.resizeLike(policy_.inputs);
    trial_.states.resizeLike(policy_.states);
    trial_.states.col(0) = policy_.states.col(0);
    for (Eigen::Index k = 0; k < policy_.horizon(); ++k) {
      auto input = trial_.inputs.col(k);
      sweep_.away = trial_.states.col(k) - policy_.states.col(k);
      input = policy_.inputs.col(k) + share * steps_.col(k);
      input.noalias() += policy_.gains[static_cast<std::size_t>(k)] * sweep_.away;
      clamp_inputs(problem_.bounds, input);
      dynamics_.step(View(trial_.states.col(k).data(), dim, 1), View(input.data(), input.rows(), 1),
                     Eigen::Map<models::StateBatch>(trial_.states.col(k + 1).data(), dim, 1));
    }
    ++evaluations;
    const CostParts cost = cost_of(trial_);
    if (!(cost.total() < cost_.total())) continue;
    std::swap(policy_.inputs, trial_.inputs);
    std::swap(policy_.states, trial_.states);
    cost_ = cost;
    return true;
  }
  return false;
}

const Decision& PathRegulator::decide(const Situation& situation) {
  const auto start = Clock::now();
  check_situation(situation, dynamics_.state_dim());
  place_target(problem_, dynamics_.description(), situation.belief.mean, situation.progress,
               cost_about_);
  if (under_way_) {
    shift_inputs(policy_.inputs, trial_.inputs);
    std::swap(policy_.inputs, trial_.inputs);
  } else {
    reset(0);
  }
  nominal_states(dynamics_, situation.belief.mean, policy_.inputs, policy_.states);
  cost_ = cost_of(policy_);
  int evaluations = 1;
  SolverStatus status = SolverStatus::kIterationLimit;
  while (evaluations < problem_.max_evaluations) {
    if (Clock::now() >= situation.deadline) {
      status = SolverStatus::kDeadline;
      break;
    }
    const double before = cost_.total();
    linearise();
    if (!std::isfinite(before) || !steps_.allFinite()) {
      status = SolverStatus::kNumericalTrouble;
      break;
    }
    if (!improve(evaluations) || before - cost_.total() <= kSweepSettled * std::abs(before)) {
      status = SolverStatus::kConverged;
      break;
    }
  }
  // Inputs whose path is not finite cannot warm-start the next period.
  under_way_ = status != SolverStatus::kNumericalTrouble;
  lqr_gains(dynamics_, policy_.states, policy_.inputs, weights_, scratch_, policy_.gains);
  for (Eigen::MatrixXd& gain : policy_.gains) {
    if (!gain.allFinite()) gain.setZero();
  }
  policy_input(policy_, 0, situation.observation, sweep_.away, decision_.input);
  decision_.policy = &policy_;
  decision_.cost = cost_;
  decision_.status = status;
  decision_.evaluations = evaluations;
  decision_.timing = {.optimise =
                          std::chrono::duration<double, std::milli>(Clock::now() - start).count()};
  return decision_;
}

std::unique_ptr<Controller> make_lqr(const models::Dynamics& dynamics,
                                     const ControllerSettings& settings) {
  check_planner_settings(settings.problem, dynamics.state_dim(), dynamics.input_dim());
  if (settings.lqr_about == LqrAbout::kTarget) {
    return std::make_unique<TargetRegulator>(dynamics, settings.problem);
  }
  return std::make_unique<PathRegulator>(dynamics, settings.problem);
}

DecisionParts lqr_parts(const ControllerSettings& settings) {
  if (settings.lqr_about == LqrAbout::kTarget) return {};
  return {.stages = settings.problem.horizon, .cost = true, .status = true};
}

}  // namespace

ControllerEntry lqr_controller() {
  return {.name = "lqr",
          .summary = "linear-quadratic regulator about the path or the target; ignores obstacles",
          .parts = lqr_parts,
          .make = make_lqr};
}

}  // namespace qsmpc::controller
