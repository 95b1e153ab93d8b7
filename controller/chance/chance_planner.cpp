#include "controller/chance/chance_planner.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include <boost/math/distributions/normal.hpp>

#include "controller/chance/scenario.hpp"
#include "controller/planning/guide/guided_target.hpp"
#include "controller/planning/plan_in_progress.hpp"
#include "controller/planning/start/first_guess.hpp"
#include "models/constants.hpp"
#include "models/linear_algebra.hpp"
#include "models/random/random_numbers.hpp"

namespace qsmpc::controller {
namespace {

using Clock = std::chrono::steady_clock;

// Unit of the constraints in the augmented Lagrangian, m.
constexpr double kUnit = 0.1;
// Tolerance of the constraints, in that unit; they are tightened by as much.
constexpr double kTolerance = 5e-4;
// Most minimisations until the multipliers have converged, for warm and cold starts.
constexpr int kWarmRounds = 6;
constexpr int kColdRounds = 20;
// Relative tolerance of the minimisations, as for warm-started plans of the quantised planner.
constexpr double kMinimisationTolerance = 1e-7;
// A tube leaves the nominal input at least this share of its range.
constexpr double kLeastInputShare = 0.05;

PlannerSettings without_noise(PlannerSettings settings) {
  settings.propagator = "noise_free";
  settings.state_points = 1;
  settings.quantiser = QuantiserKind::kProduct;
  settings.solver = "lbfgs";
  settings.optimise_gain = false;
  settings.risk = {};
  settings.otherwise = RiskOtherwise::kLeastRisk;
  settings.model_error.reset();
  settings.deadline = std::numeric_limits<double>::infinity();
  return settings;
}

Eigen::MatrixXd root_of(const Eigen::MatrixXd& covariance) {
  const models::SymmetricEigen eigen = models::symmetric_eigen(covariance);
  return eigen.vectors * eigen.values.cwiseMax(0.0).cwiseSqrt().asDiagonal();
}

ChancePlannerSettings checked(ChancePlannerSettings settings, const models::Dynamics& dynamics) {
  check_planner_settings(settings.problem, dynamics.state_dim(), dynamics.input_dim());
  check_chance_settings(settings.chance);
  if (settings.chance.memory > 0 && !chance_constraint_entry(settings.constraint).samples) {
    throw std::invalid_argument("chance constraint: " + settings.constraint +
                                " samples no noise, so the memory must be 0");
  }
  return settings;
}

Eigen::Index paths_of(const ChancePlannerSettings& settings, const models::Dynamics& dynamics) {
  if (!chance_constraint_entry(settings.constraint).samples) return 0;
  if (settings.chance.paths > 0) return settings.chance.paths;
  if (settings.constraint != "scenario") return kUsualPaths;
  const PlannerSettings& problem = settings.problem;
  const SampledPaths sizes(dynamics, problem.bounds, problem.horizon, settings.chance.memory);
  return scenario_samples(settings.chance.risk, settings.chance.confidence,
                          static_cast<int>(sizes.decisions()));
}

}  // namespace

/// The chance constraint at all stages as a function of the decision, in kUnit.
class ChancePlanner::Constraints final : public SummedConstraints {
 public:
  Constraints(ChanceConstraint& constraint, SampledPaths& paths)
      : constraint_(constraint), paths_(paths), values_(constraint.per_stage() * paths.horizon()) {}

  [[nodiscard]] Eigen::Index count() const override { return values_.size(); }

  const Eigen::VectorXd& values(const Eigen::VectorXd& z) override {
    paths_.rollout(z);
    const Eigen::Index n = constraint_.per_stage();
    for (Eigen::Index k = 0; k < paths_.horizon(); ++k) {
      constraint_.values(k + 1, paths_, values_.segment(k * n, n));
    }
    values_ = values_ / kUnit;
    values_.array() += kTolerance;
    return values_;
  }

  /// Also pulls back what the paths' adjoints already hold, in one pass.
  void add_gradient(const Eigen::VectorXd& multipliers, Eigen::VectorXd& gradient) override {
    const Eigen::Index n = constraint_.per_stage();
    scaled_ = multipliers / kUnit;
    for (Eigen::Index k = 0; k < paths_.horizon(); ++k) {
      const auto of_stage = scaled_.segment(k * n, n);
      if (!of_stage.isZero(0.0)) constraint_.add_adjoint(k + 1, of_stage, paths_);
    }
    paths_.pull_back(gradient);
  }

 private:
  ChanceConstraint& constraint_;
  SampledPaths& paths_;
  Eigen::VectorXd values_;
  Eigen::VectorXd scaled_;
};

ChancePlanner::~ChancePlanner() = default;

ChancePlanner::ChancePlanner(const models::Dynamics& dynamics,
                             const ChancePlannerSettings& settings)
    : dynamics_(dynamics),
      settings_(checked(settings, dynamics)),
      unsafe_(settings_.problem.safe_set),
      path_count_(paths_of(settings_, dynamics)),
      sampled_(dynamics, settings_.problem.bounds, settings_.problem.horizon,
               settings_.chance.memory),
      guide_(make_guide(dynamics_, settings_.problem)),
      policies_(dynamics_, settings_.problem),
      weights_(settings_.problem.cost),
      noise_root_(root_of(settings_.problem.noise_covariance)),
      no_change_(Eigen::MatrixXd::Zero(dynamics.input_dim(), dynamics.state_dim())) {
  const PlannerSettings& problem = settings_.problem;
  constraint_ = chance_constraint_entry(settings_.constraint)
                    .make({.unsafe = unsafe_,
                           .settings = settings_.chance,
                           .horizon = problem.horizon,
                           .paths = path_count_});
  constraints_ = std::make_unique<Constraints>(*constraint_, sampled_);
  nominal_.emplace(dynamics_, without_noise(problem));
  draw_.start.resize(dynamics.state_dim(), path_count_);
  if (path_count_ > 0) draw_.noise.resize(static_cast<std::size_t>(problem.horizon));
  covariances_.resize(static_cast<std::size_t>(problem.horizon) + 1);
  problem_.cost = [this](const Eigen::VectorXd& z, Eigen::VectorXd& gradient) {
    sampled_.rollout(z);
    sampled_.clear_adjoints();
    gradient.setZero();
    plan_.cost = sampled_.add_cost(weights_);
    return plan_.cost.total() + lagrangian_.add(z, gradient);
  };
  problem_.lower.setConstant(sampled_.decisions(), -kInfinity);
  problem_.upper.setConstant(sampled_.decisions(), kInfinity);
  problem_.lower.head(sampled_.inputs_in_decision()) =
      problem.bounds.lower.replicate(problem.horizon, 1);
  problem_.upper.head(sampled_.inputs_in_decision()) =
      problem.bounds.upper.replicate(problem.horizon, 1);
  z_.setZero(sampled_.decisions());
}

void ChancePlanner::reset(std::uint64_t seed) {
  seed_ = seed;
  under_way_ = false;
}

/// Draws new paths, independent of everything observed in the drive so far.
void ChancePlanner::draw(const Gaussian& belief, Eigen::Index period) {
  if (path_count_ == 0) return;
  if (belief_covariance_.size() == 0 || belief_covariance_ != belief.covariance) {
    belief_covariance_ = belief.covariance;
    belief_root_ = root_of(belief.covariance);
  }
  models::RandomKey key{.seed = seed_,
                        .episode = static_cast<std::uint64_t>(period),
                        .stream = models::RandomStream::kPlanning};
  normals_.resize(dynamics_.state_dim(), path_count_);
  const auto draw_normals = [&] {
    models::standard_normals(key, {normals_.data(), static_cast<std::size_t>(normals_.size())});
    ++key.step;
  };
  draw_normals();
  draw_.start.noalias() = belief_root_ * normals_;
  draw_.start.colwise() += belief.mean;
  for (Points& noise : draw_.noise) {
    draw_normals();
    noise.noalias() = noise_root_ * normals_;
  }
}

/// Starts from the inputs of a noise-free plan with penalties, which finds a way round obstacles.
bool ChancePlanner::first_guess(const Gaussian& belief, Clock::time_point deadline) {
  nominal_->reset();
  const Plan& plan = nominal_->plan(belief, {.deadline = deadline, .progress = progress_});
  if (!std::isfinite(plan.cost.total())) return false;
  z_.setZero();
  z_.head(sampled_.inputs_in_decision()) = plan.policy.inputs.reshaped();
  return true;
}

/// Computes and holds the gains, covariances and back-offs for the inputs in z_.
void ChancePlanner::hold(const Gaussian& belief) {
  const Eigen::Index horizon = settings_.problem.horizon;
  const bool feedback = settings_.problem.closed_loop && settings_.chance.memory == 0;
  inputs_ = z_.head(sampled_.inputs_in_decision()).reshaped(dynamics_.input_dim(), horizon);
  policies_.make(belief.mean, inputs_, no_change_, held_);
  if (!feedback) {
    for (Eigen::MatrixXd& gain : held_.gains) gain.setZero();
  }
  sampled_.hold_gains(feedback ? held_.gains : no_gains_);
  if (path_count_ > 0) return;
  a_.resize(dynamics_.state_dim(), dynamics_.state_dim());
  b_.resize(dynamics_.state_dim(), dynamics_.input_dim());
  covariances_[0] = belief.covariance;
  for (Eigen::Index k = 0; k < horizon; ++k) {
    dynamics_.jacobians(held_.states.col(k), held_.inputs.col(k), a_, b_);
    a_.noalias() += b_ * held_.gains[k];
    moved_.noalias() = a_ * covariances_[k];
    covariances_[k + 1] = settings_.problem.noise_covariance;
    covariances_[k + 1].noalias() += moved_ * a_.transpose();
  }
  if (settings_.tightened_inputs) tighten();
  sampled_.rollout(z_);
  constraint_->hold({.covariances = covariances_}, sampled_);
}

/// Tightens the bounds of the nominal inputs by what feedback needs, as far as there is room.
void ChancePlanner::tighten() {
  const InputBounds& bounds = settings_.problem.bounds;
  const Eigen::Index inputs = bounds.lower.size();
  const double factor =
      boost::math::quantile(boost::math::complement(boost::math::normal(), settings_.chance.risk));
  for (Eigen::Index k = 0; k < settings_.problem.horizon; ++k) {
    const Eigen::MatrixXd& gain = held_.gains[k];
    for (Eigen::Index i = 0; i < inputs; ++i) {
      double variance = 0.0;
      for (Eigen::Index j = 0; j < gain.cols(); ++j) {
        variance += gain(i, j) * gain.row(i).dot(covariances_[k].col(j));
      }
      const double deviation = std::sqrt(std::max(0.0, variance));
      const double range = bounds.upper[i] - bounds.lower[i];
      const double in = std::clamp(factor * deviation, 0.0, 0.5 * (1.0 - kLeastInputShare) * range);
      problem_.lower[k * inputs + i] = bounds.lower[i] + in;
      problem_.upper[k * inputs + i] = bounds.upper[i] - in;
    }
  }
}

double ChancePlanner::violation_at(const Eigen::VectorXd& z) {
  const Eigen::VectorXd& values = constraints_->values(z);
  if (values.size() == 0) return 0.0;
  if (!values.allFinite()) return kInfinity;
  return std::max(0.0, kUnit * (values.maxCoeff() - kTolerance));
}

/// Augmented-Lagrangian minimisations from z_ until the multipliers have converged; result in z_.
void ChancePlanner::search(const Gaussian& belief, bool warm, Clock::time_point deadline) {
  if (!warm) solver_.forget();
  hold(belief);
  sampled_.rollout(z_);
  sampled_.clear_adjoints();
  lagrangian_.start(*constraints_, sampled_.add_cost(weights_).total(), warm);
  SolverOptions options{.max_evaluations = settings_.problem.max_evaluations,
                        .relative_tolerance = kMinimisationTolerance,
                        .deadline = deadline};
  const int rounds = warm ? kWarmRounds : kColdRounds;
  for (int n = 0; n < rounds; ++n) {
    if (n > 0) hold(belief);
    const SolverResult& result = solver_.minimise(problem_, z_, options);
    plan_.evaluations += result.evaluations;
    plan_.status = result.status;
    if (!std::isfinite(result.value)) {
      if (result.status != SolverStatus::kDeadline) {
        plan_.status = SolverStatus::kNumericalTrouble;
      }
      break;
    }
    z_ = result.z;
    if (result.status == SolverStatus::kDeadline || !lagrangian_.update(z_, kTolerance)) break;
    if (Clock::now() >= deadline) {
      plan_.status = SolverStatus::kDeadline;
      break;
    }
  }
  plan_.violation = violation_at(z_);
  const bool ended =
      plan_.status != SolverStatus::kDeadline && plan_.status != SolverStatus::kNumericalTrouble;
  if (ended && plan_.violation > 0.0) plan_.status = SolverStatus::kInfeasible;
}

const ChancePlan& ChancePlanner::plan(const Gaussian& belief, Eigen::Index period,
                                      Clock::time_point deadline, std::optional<double> progress) {
  progress_ = progress;
  draw(belief, period);
  return make(belief, deadline);
}

const ChancePlan& ChancePlanner::plan(const Gaussian& belief, PathDraw draw,
                                      Clock::time_point deadline) {
  const auto fits = [&](const Points& points) {
    return points.rows() == dynamics_.state_dim() && points.cols() == path_count_;
  };
  if (!fits(draw.start) || draw.noise.size() != draw_.noise.size() ||
      !std::all_of(draw.noise.begin(), draw.noise.end(), fits)) {
    throw std::invalid_argument("chance constraint: the paths do not have the expected sizes");
  }
  draw_ = std::move(draw);
  progress_.reset();
  return make(belief, deadline);
}

/// A plan for the drawn paths.
const ChancePlan& ChancePlanner::make(const Gaussian& belief, Clock::time_point deadline) {
  if (std::isfinite(settings_.problem.deadline)) {
    const auto longest = std::chrono::duration_cast<Clock::duration>(
        std::chrono::duration<double>(settings_.problem.deadline));
    deadline = std::min(deadline, Clock::now() + longest);
  }
  plan_.timing = {};
  plan_.evaluations = 0;
  PlanStopwatch stopwatch;
  place_guided_target(guide_, settings_.problem, dynamics_.description(), belief.mean, progress_,
                      weights_);
  sampled_.hold(belief.mean, draw_);
  const bool warm = under_way_;
  if (warm) {
    move_on();
  } else if (!first_guess(belief, deadline)) {
    z_.setZero();
  }
  stopwatch.add_to(plan_.timing.propagate);
  search(belief, warm, deadline);
  if (warm && plan_.status == SolverStatus::kInfeasible) {
    // Another way round the obstacles may be feasible.
    best_ = z_;
    const double violation = plan_.violation;
    if (first_guess(belief, deadline)) search(belief, false, deadline);
    // The deadline may have ended it too early to be better.
    if (!(plan_.violation < violation)) {
      z_ = best_;
      hold(belief);
      plan_.violation = violation;
      plan_.status = SolverStatus::kInfeasible;
    }
  }
  take_result(belief);
  stopwatch.add_to(plan_.timing.optimise);
  return plan_;
}

/// Shifts the last decision, its curvature and its multipliers by one stage.
void ChancePlanner::move_on() {
  sampled_.shift(z_);
  if (settings_.chance.memory > 0) {
    solver_.forget();
  } else {
    solver_.shift({.inputs_per_stage = dynamics_.input_dim(), .horizon = sampled_.horizon()});
  }
  if (path_count_ > 0 && constraint_->per_stage() == path_count_) {
    lagrangian_.release();  // they belong to other paths
  } else {
    lagrangian_.shift({.count = constraints_->count(), .of_stage = constraint_->per_stage()});
  }
}

/// Makes the plan of the decision in z_.
void ChancePlanner::take_result(const Gaussian& belief) {
  plan_.policy = held_;
  plan_.policy.inputs =
      z_.head(sampled_.inputs_in_decision()).reshaped(dynamics_.input_dim(), sampled_.horizon());
  nominal_states(dynamics_, belief.mean, plan_.policy.inputs, plan_.policy.states);
  plan_.violation = violation_at(z_);
  sampled_.clear_adjoints();
  plan_.cost = sampled_.add_cost(weights_);
  plan_.believed = constraint_->believed(1, sampled_);
  under_way_ = std::isfinite(plan_.cost.total());
}

}  // namespace qsmpc::controller
