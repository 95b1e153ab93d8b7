#include "controller/certification/affine_surrogate.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "controller/certification/error_truncation.hpp"
#include "controller/certification/statistical_linearisation.hpp"
#include "controller/certification/tilted_covariance.hpp"
#include "controller/certification/unicycle_residual.hpp"
#include "models/constants.hpp"

namespace qsmpc::controller {
namespace {

/// Bounds of a sum.
StageError added(const StageError& one, const StageError& other) {
  return {.bounds = one.bounds + other.bounds};
}

/// The better of two bounds of the same error.
StageError lesser(const StageError& one, const StageError& other) {
  return {.bounds = one.bounds.cwiseMin(other.bounds)};
}

/// sizes · bounds with 0 · ∞ = 0: an unknown coordinate, whose bound is infinite, does not affect
/// those that do not depend on it.
StageError::Bounds product(const Eigen::Ref<const Eigen::MatrixXd>& sizes,
                           const Eigen::Ref<const StageError::Bounds>& bounds) {
  // A coefficient-wise product: the matrices are too small for a blocked one to pay.
  if (bounds.allFinite()) return sizes.lazyProduct(bounds);
  StageError::Bounds result = StageError::Bounds::Zero(sizes.rows(), StageError::kColumns);
  for (Eigen::Index column = 0; column < StageError::kColumns; ++column) {
    for (Eigen::Index i = 0; i < sizes.rows(); ++i) {
      for (Eigen::Index a = 0; a < sizes.cols(); ++a) {
        if (sizes(i, a) == 0.0 || bounds(a, column) == 0.0) continue;
        result(i, column) += sizes(i, a) * bounds(a, column);
      }
    }
  }
  return result;
}

/// Bounds of an error after a linear map whose entries are at most `sizes` in absolute value.
StageError moved(const Eigen::MatrixXd& sizes, const StageError& error) {
  return {.bounds = product(sizes, error.bounds)};
}

/// `error` on the event that it is at most `largest`, which then bounds its unknown norms.
StageError where_limited(StageError error) {
  for (std::size_t k = 0; k < kHigherOrders.size(); ++k) {
    error.higher(k) = error.higher(k).array().isFinite().select(error.higher(k), error.largest());
  }
  return error;
}

/// Residuals of all stages so far, each with its bounds and the map that takes it to the current
/// stage.
class CarriedErrors {
 public:
  /// For at most `count` residuals of `dim` coordinates.
  CarriedErrors(Eigen::Index dim, Eigen::Index count)
      : dim_(dim),
        maps_(dim, dim * count),
        sizes_(dim, dim * count),
        bounds_(dim * count, StageError::kColumns) {}

  /// Propagates all of them by `transition`.
  void carry(const Eigen::MatrixXd& transition) {
    // `sizes_` is scratch here: the product must not overwrite its own operand.
    sizes_.leftCols(used_) = transition.lazyProduct(maps_.leftCols(used_));
    maps_.leftCols(used_) = sizes_.leftCols(used_);
    sizes_.leftCols(used_) = maps_.leftCols(used_).cwiseAbs();
  }

  /// Adds a residual of the current stage.
  void add(const StageError& error) {
    maps_.middleCols(used_, dim_).setIdentity();
    sizes_.middleCols(used_, dim_).setIdentity();
    bounds_.middleRows(used_, dim_) = error.bounds;
    used_ += dim_;
  }

  /// Bounds of their sum at the current stage.
  [[nodiscard]] StageError sum() const {
    return {.bounds = product(sizes_.leftCols(used_), bounds_.topRows(used_))};
  }

 private:
  Eigen::Index dim_;
  Eigen::MatrixXd maps_;       ///< Φ_{k,j+1} side by side, dim x dim each
  Eigen::MatrixXd sizes_;      ///< of the maps' entries
  StageError::Bounds bounds_;  ///< of the residuals, below one another
  Eigen::Index used_ = 0;      ///< columns and rows
};

/// The recursion from stage to stage: the law, and the error
///     x − z = Σ_j Φ_{k,j+1} (r_j(x_j) + e_j − m_j),   r_j(x_j) = r_j(z_j) + [r_j(x_j) − r_j(z_j)],
/// with Φ the products of the affine maps' linear parts and e_j the model error, if there is one,
/// whose known offset m_j also shifts z.
class SurrogateRecursion {
 public:
  SurrogateRecursion(const PredictedMotion& motion, double core, const PathTilt& tilt)
      : motion_(motion),
        core_{.affine = affine_coordinates(motion.dynamics), .reach = core},
        law_(motion.belief),
        tilted_(tilt),
        error_(StageError::none(law_.mean.size())),
        past_(law_.mean.size(), motion.policy.horizon() + 1) {
    // If the fit holds everywhere, the residual is known on the whole space, and only its
    // differences r(x) − r(z) need the core.
    fits_everywhere_ =
        std::all_of(core_.affine.begin(), core_.affine.end(), [](bool one) { return one; });
    if (const std::optional<models::UnicycleStructure> unicycle = motion.dynamics.unicycle()) {
      residual_.emplace(*unicycle, law_.mean.size(), motion.policy.horizon());
      fits_everywhere_ = true;
    }
    if (motion.belief_error != nullptr) start_from(*motion.belief_error);
    tilted_.start(law_);
  }

  /// The surrogate of the current stage; its `transition` and `region` follow from the next step.
  [[nodiscard]] SurrogateStage stage() const {
    const Eigen::Index dim = law_.mean.size();
    SurrogateStage stage{.law = law_,
                         .with_last = tilted_.with_last(),
                         .transition = {},
                         .error = error_.mean_square(),
                         .higher = {},
                         .largest = error_.largest(),
                         .leaving = leaving_,
                         .region = {.lower = Eigen::VectorXd::Constant(dim, -kInfinity),
                                    .upper = Eigen::VectorXd::Constant(dim, kInfinity)}};
    for (std::size_t k = 0; k < kHigherOrders.size(); ++k) stage.higher[k] = error_.higher(k);
    return stage;
  }

  /// Takes the step of stage `stage` and completes `before`, the surrogate before it. False once
  /// nothing finite is known.
  bool step(Eigen::Index stage, SurrogateStage& before) {
    // Everything that uses this is conditional on the event that the next stage is inside.
    const StageError before_step = where_limited(error_);
    const std::vector<InputLinearisation> inputs =
        linearise_inputs(motion_, stage, law_, before_step);
    // With non-finite feedback there is no box to fit over.
    if (!std::all_of(inputs.begin(), inputs.end(), [](const InputLinearisation& input) {
          return std::isfinite(input.mean) && std::isfinite(input.deviation);
        })) {
      return false;
    }
    const StatisticalLinearisation fit =
        linearise_stage(motion_, stage, law_, before_step, inputs, core_);
    before.transition = fit.transition;
    const StageError difference = residual_difference(before_step, fit, inputs);
    outside_ += fit.outside;
    const bool uses_core = !fits_everywhere_ || !difference.mean_square().isZero(0.0);
    if (uses_core) {
      leaving_ = std::min(1.0, outside_);
      before.region = fit.region;
    }
    if (residual_) residual_->add_stage(law_, fit.transition, &tilted_);
    StageError own = fit.residual;
    const ModelError* error = motion_.error_at(stage);
    TruncatedError cut;
    if (error != nullptr) {
      cut = truncate_error(*error, error_count(), core_.reach);
      own = added(own, cut.bound);
    }
    carry(fit.transition, added(own, difference));
    // Where the feedback is clamped and large, the step's own slopes may give less growth than the
    // products of the affine maps.
    if (uses_core) {
      StageError slopes = moved(fit.growth, before_step);
      slopes.mean_square() += fit.closed_form;
      error_ = lesser(error_, added(slopes, own));
    }
    law_.mean = fit.next_mean;
    tilted_.step(stage, fit.transition, motion_.noise_covariance, law_);
    if (error != nullptr) move_mean(*error);
    outside_ += cut.outside;
    return law_.mean.allFinite() && law_.covariance.allFinite() &&
           error_.mean_square().allFinite() && error_.largest().allFinite();
  }

 private:
  /// The number of model errors along the horizon, including that of the belief.
  [[nodiscard]] Eigen::Index error_count() const {
    return motion_.policy.horizon() + static_cast<Eigen::Index>(motion_.belief_error != nullptr);
  }

  /// Shifts the surrogate by the known offset of `error`, like the state.
  void move_mean(const ModelError& error) {
    if (error.offset.size() > 0) law_.mean += error.offset;
  }

  /// At stage 0 the state differs by `error` from a variable with the belief's law, and by `error`
  /// less its offset from the surrogate.
  void start_from(const ModelError& error) {
    const TruncatedError cut = truncate_error(error, error_count(), core_.reach);
    error_ = cut.bound;
    outside_ = cut.outside;
    past_.add(cut.bound);
    move_mean(error);
  }

  /// Bounds of r(x) − r(z) where x − z has the bounds `error`. Its `largest` is zero because that
  /// of the fit's residual bounds |r(x)| itself over the region.
  [[nodiscard]] static StageError residual_difference(
      const StageError& error, const StatisticalLinearisation& fit,
      const std::vector<InputLinearisation>& inputs) {
    StageError difference = moved(fit.stretch, error);
    difference.largest().setZero();
    for (std::size_t b = 0; b < inputs.size(); ++b) {
      const auto gain = fit.input_gain.col(static_cast<Eigen::Index>(b));
      difference.mean_square() += gain * inputs[b].difference;
      for (std::size_t k = 0; k < kHigherOrders.size(); ++k) {
        difference.higher(k) += gain * inputs[b].higher_difference[k];
      }
    }
    return difference;
  }

  /// Propagates the residuals of earlier stages and adds this stage's, bounded by `bound`.
  void carry(const Eigen::MatrixXd& transition, const StageError& bound) {
    past_.carry(transition);
    past_.add(bound);
    error_ = past_.sum();
    if (residual_) error_.mean_square() += residual_->root_mean_squares();
  }

  const PredictedMotion& motion_;
  CoreShape core_;
  Gaussian law_;
  TiltedCovariance tilted_;
  StageError error_;
  bool fits_everywhere_ = false;
  double outside_ = 0.0;  ///< Σ P(z_j not in its core) + P(an error beyond its cut)
  double leaving_ = 0.0;
  std::optional<UnicycleResidual> residual_;
  CarriedErrors past_;
};

bool open_loop(const Policy& policy) {
  return std::all_of(policy.gains.begin(), policy.gains.end(),
                     [](const auto& gain) { return gain.isZero(0.0); });
}

/// Covariance of (x, y) under N(0, covariance).
Eigen::Matrix2d of_position(const models::UnicycleStructure& unicycle,
                            const Eigen::MatrixXd& covariance) {
  Eigen::Matrix2d position;
  position << covariance(unicycle.x, unicycle.x), covariance(unicycle.x, unicycle.y),
      covariance(unicycle.y, unicycle.x), covariance(unicycle.y, unicycle.y);
  return position;
}

/// Covariance of the part of (x, y) that is independent of the heading, under N(0, covariance).
Eigen::Matrix2d beside_heading(const models::UnicycleStructure& unicycle,
                               const Eigen::MatrixXd& covariance) {
  const double variance = covariance(unicycle.heading, unicycle.heading);
  Eigen::Matrix2d beside = of_position(unicycle, covariance);
  if (variance > 0.0) {
    const Eigen::Vector2d cross(covariance(unicycle.x, unicycle.heading),
                                covariance(unicycle.y, unicycle.heading));
    beside -= cross * cross.transpose() / variance;
  }
  return beside;
}

}  // namespace

std::vector<SurrogateStage> affine_surrogates(const PredictedMotion& motion, double core,
                                              const PathTilt& tilt) {
  SurrogateRecursion recursion(motion, core, tilt);
  std::vector<SurrogateStage> stages = {recursion.stage()};
  bool known = true;
  for (Eigen::Index k = 0; k < motion.policy.horizon(); ++k) {
    known = known && recursion.step(k, stages.back());
    stages.push_back(recursion.stage());
    if (known) continue;
    SurrogateStage& lost = stages.back();
    lost.error.setConstant(kInfinity);
    for (Eigen::VectorXd& norms : lost.higher) norms.setConstant(kInfinity);
    lost.largest.setConstant(kInfinity);
    lost.leaving = 1.0;
  }
  return stages;
}

Eigen::MatrixXd smoothing_covariance(const PredictedMotion& motion, Eigen::Index stage,
                                     const std::vector<Eigen::Index>& axes, const PathTilt& tilt) {
  // A model error may depend on the past in an unknown way.
  if (motion.model_error != nullptr || motion.belief_error != nullptr) {
    return motion.noise_covariance;
  }
  const std::optional<models::UnicycleStructure> unicycle = motion.dynamics.unicycle();
  const bool always_open = open_loop(motion.policy);
  const bool heading =
      unicycle && std::find(axes.begin(), axes.end(), unicycle->heading) != axes.end();
  // The last noise is independent of everything before it; under a tilt, a part of it is.
  Eigen::MatrixXd last = independent_part(motion.noise_covariance, tilt, stage);
  if (!unicycle || (heading && !always_open)) return last;
  // The position's error depends on the headings before the last step. In open loop only the
  // headings' own noise moves them; with feedback the position of stage k − 2 is the last that can,
  // so that the noise which entered the position of stage k − 1 is still independent. Where the
  // heading itself is restricted, noise of the position that is correlated with it must not count
  // either.
  // A tilt that concerns only headings does not change the part independent of them.
  Eigen::Matrix2d sum = heading ? beside_heading(*unicycle, last) : of_position(*unicycle, last);
  double noises = 0.0;
  for (Eigen::Index block = always_open ? 1 : std::max<Eigen::Index>(1, stage - 1); block < stage;
       ++block) {
    if (concerns_only(tilt, block, unicycle->heading)) noises += 1.0;
  }
  Eigen::Matrix2d before = noises * beside_heading(*unicycle, motion.noise_covariance);
  if ((always_open || stage == 1) && concerns_only(tilt, 0, unicycle->heading)) {
    before += beside_heading(*unicycle, motion.belief.covariance);
  }
  sum += before;
  Eigen::MatrixXd smoothing =
      Eigen::MatrixXd::Zero(motion.noise_covariance.rows(), motion.noise_covariance.cols());
  smoothing(unicycle->x, unicycle->x) = sum(0, 0);
  smoothing(unicycle->x, unicycle->y) = sum(0, 1);
  smoothing(unicycle->y, unicycle->x) = sum(1, 0);
  smoothing(unicycle->y, unicycle->y) = sum(1, 1);
  return smoothing;
}

}  // namespace qsmpc::controller
