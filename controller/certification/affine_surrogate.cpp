#include "controller/certification/affine_surrogate.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include <Eigen/Cholesky>

#include "controller/certification/error_cut.hpp"
#include "controller/certification/stage_fit.hpp"
#include "controller/certification/unicycle_residual.hpp"

namespace qsmpc {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Applies `combine` to each bound of the one and of the other.
template <class Combine>
StageError combined(const StageError& one, const StageError& other, Combine combine) {
  StageError result{.mean_square = combine(one.mean_square, other.mean_square),
                    .higher = {},
                    .largest = combine(one.largest, other.largest)};
  for (std::size_t k = 0; k < kHigherOrders.size(); ++k) {
    result.higher[k] = combine(one.higher[k], other.higher[k]);
  }
  return result;
}

/// Bounds of a sum.
StageError added(const StageError& one, const StageError& other) {
  return combined(one, other, [](const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
    return Eigen::VectorXd(a + b);
  });
}

/// The better of two bounds of the same error.
StageError lesser(const StageError& one, const StageError& other) {
  return combined(one, other, [](const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
    return Eigen::VectorXd(a.cwiseMin(b));
  });
}

/// sizes · bounds, where a coordinate of which nothing is known is infinite and does not matter to
/// those that do not depend on it (0 · ∞ = 0).
Eigen::VectorXd product(const Eigen::MatrixXd& sizes, const Eigen::VectorXd& bounds) {
  if (bounds.allFinite()) return sizes * bounds;
  Eigen::VectorXd result = Eigen::VectorXd::Zero(sizes.rows());
  for (Eigen::Index i = 0; i < sizes.rows(); ++i) {
    for (Eigen::Index a = 0; a < sizes.cols(); ++a) {
      if (sizes(i, a) != 0.0 && bounds[a] != 0.0) result[i] += sizes(i, a) * bounds[a];
    }
  }
  return result;
}

/// Bounds of an error after a map whose entries are at most `sizes` in size.
StageError moved(const Eigen::MatrixXd& sizes, const StageError& error) {
  return combined(error, error, [&](const Eigen::VectorXd& a, const Eigen::VectorXd&) {
    return product(sizes, a);
  });
}

/// `error` in the event in which it is at most `largest`: this bounds norms that are unknown.
StageError where_limited(StageError error) {
  for (Eigen::VectorXd& norms : error.higher) {
    norms = norms.array().isFinite().select(norms, error.largest);
  }
  return error;
}

/// The recursion from stage to stage: the law, and the error
///     x − z = Σ_j Φ_{k,j+1} (r_j(x_j) + e_j − m_j),   r_j(x_j) = r_j(z_j) + [r_j(x_j) − r_j(z_j)],
/// with Φ the products of the affine maps' linear parts and e_j the model error, if there is one,
/// whose known offset m_j moves z, too.
class SurrogateRecursion {
 public:
  SurrogateRecursion(const PredictedMotion& motion, double core)
      : motion_(motion),
        core_{.affine = affine_coordinates(motion.dynamics), .reach = core},
        law_(motion.belief),
        error_{.mean_square = Eigen::VectorXd::Zero(law_.mean.size()),
               .higher = zero_norms(law_.mean.size()),
               .largest = Eigen::VectorXd::Zero(law_.mean.size())} {
    // Then a residual is known on the whole space, and only its changes need the core.
    fits_everywhere_ =
        std::all_of(core_.affine.begin(), core_.affine.end(), [](bool one) { return one; });
    if (const std::optional<UnicycleStructure> unicycle = motion.dynamics.unicycle()) {
      residual_.emplace(*unicycle, law_.mean.size());
      fits_everywhere_ = true;
    }
    if (motion.belief_error != nullptr) start_from(*motion.belief_error);
  }

  /// The surrogate of the present stage, with `region` as far as the next step tells.
  [[nodiscard]] SurrogateStage stage() const {
    const Eigen::Index dim = law_.mean.size();
    return {.law = law_,
            .transition = {},
            .error = error_.mean_square,
            .higher = error_.higher,
            .largest = error_.largest,
            .leaving = leaving_,
            .region = {.lower = Eigen::VectorXd::Constant(dim, -kInfinity),
                       .upper = Eigen::VectorXd::Constant(dim, kInfinity)}};
  }

  /// Takes the step of stage `stage` and completes `before`, the surrogate before it. False once
  /// nothing finite is known.
  bool step(Eigen::Index stage, SurrogateStage& before) {
    // All that rests on what this leaves is in the event that is inside at the next stage.
    const StageError before_step = where_limited(error_);
    const std::vector<InputFit> inputs = fit_inputs(motion_, stage, law_, before_step);
    // A plan that was lost has no boxes to fit anything over.
    if (!std::all_of(inputs.begin(), inputs.end(), [](const InputFit& input) {
          return std::isfinite(input.mean) && std::isfinite(input.deviation);
        })) {
      return false;
    }
    const StageFit fit = fit_stage(motion_, stage, law_, before_step, inputs, core_);
    before.transition = fit.transition;
    const StageError difference = residual_difference(before_step, fit, inputs);
    outside_ += fit.outside;
    const bool uses_core = !fits_everywhere_ || !difference.mean_square.isZero(0.0);
    if (uses_core) {
      leaving_ = std::min(1.0, outside_);
      before.region = fit.region;
    }
    if (residual_) residual_->add_stage(law_, fit.transition);
    StageError own{.mean_square = fit.residual, .higher = fit.higher, .largest = fit.largest};
    const ModelError* error = motion_.error_at(stage);
    CutError cut;
    if (error != nullptr) {
      cut = cut_error(*error, error_count(), core_.reach);
      own = added(own, cut.bound);
    }
    carry(fit.transition, added(own, difference));
    // Where feedback is clamped and large, the step's own slopes may grow less than the products'.
    if (uses_core) {
      StageError slopes = moved(fit.growth, before_step);
      slopes.mean_square += fit.closed_form;
      error_ = lesser(error_, added(slopes, own));
    }
    law_.covariance =
        fit.transition * law_.covariance * fit.transition.transpose() + motion_.noise_covariance;
    law_.covariance = 0.5 * (law_.covariance + law_.covariance.transpose()).eval();
    law_.mean = fit.next_mean;
    if (error != nullptr) move_mean(*error);
    outside_ += cut.outside;
    return law_.mean.allFinite() && law_.covariance.allFinite() && error_.mean_square.allFinite() &&
           error_.largest.allFinite();
  }

 private:
  /// How many model errors there are along the horizon, that of the belief with them.
  [[nodiscard]] Eigen::Index error_count() const {
    return motion_.policy.horizon() + static_cast<Eigen::Index>(motion_.belief_error != nullptr);
  }

  /// The surrogate takes the known offset of `error` with the state.
  void move_mean(const ModelError& error) {
    if (error.offset.size() > 0) law_.mean += error.offset;
  }

  /// The state has `error` beside the belief at stage 0, and its offset less beside the surrogate.
  void start_from(const ModelError& error) {
    const Eigen::Index dim = law_.mean.size();
    const CutError cut = cut_error(error, error_count(), core_.reach);
    error_ = cut.bound;
    outside_ = cut.outside;
    past_.push_back({.product = Eigen::MatrixXd::Identity(dim, dim), .bound = cut.bound});
    move_mean(error);
  }

  /// Bounds of r(x) − r(z) where x − z has the bounds `error`; over the region `largest` holds of
  /// r(x) itself.
  [[nodiscard]] static StageError residual_difference(const StageError& error, const StageFit& fit,
                                                      const std::vector<InputFit>& inputs) {
    StageError difference = moved(fit.stretch, error);
    difference.largest.setZero();
    for (std::size_t b = 0; b < inputs.size(); ++b) {
      const Eigen::VectorXd gain = fit.input_gain.col(static_cast<Eigen::Index>(b));
      difference.mean_square += gain * inputs[b].difference;
      for (std::size_t k = 0; k < kHigherOrders.size(); ++k) {
        difference.higher[k] += gain * inputs[b].higher_difference[k];
      }
    }
    return difference;
  }

  /// Adds this stage's residual, bounded by `bound`, to those carried along.
  void carry(const Eigen::MatrixXd& transition, const StageError& bound) {
    const Eigen::Index dim = law_.mean.size();
    for (Past& past : past_) past.product = transition * past.product;
    past_.push_back({.product = Eigen::MatrixXd::Identity(dim, dim), .bound = bound});
    error_ = {.mean_square = residual_ ? residual_->root_mean_squares()
                                       : Eigen::VectorXd(Eigen::VectorXd::Zero(dim)),
              .higher = zero_norms(dim),
              .largest = Eigen::VectorXd::Zero(dim)};
    for (const Past& past : past_) {
      error_ = added(error_, moved(past.product.cwiseAbs(), past.bound));
    }
  }

  struct Past {
    Eigen::MatrixXd product;  ///< Φ_{k,j+1}
    StageError bound;         ///< of the residual
  };

  const PredictedMotion& motion_;
  CoreShape core_;
  Gaussian law_;
  StageError error_;
  bool fits_everywhere_ = false;
  double outside_ = 0.0;  ///< Σ P(z_j not in its core) + P(an error beyond its cut)
  double leaving_ = 0.0;
  std::optional<UnicycleResidual> residual_;
  std::vector<Past> past_;
};

bool open_loop(const Policy& policy) {
  return std::all_of(policy.gains.begin(), policy.gains.end(),
                     [](const auto& gain) { return gain.isZero(0.0); });
}

/// Covariance of what of (x, y) is independent of the heading, for N(0, covariance).
Eigen::Matrix2d beside_heading(const UnicycleStructure& unicycle,
                               const Eigen::MatrixXd& covariance) {
  const std::vector<int> position = {unicycle.x, unicycle.y};
  const double variance = covariance(unicycle.heading, unicycle.heading);
  Eigen::Matrix2d beside = covariance(position, position);
  if (variance > 0.0) {
    const Eigen::Vector2d cross = covariance(position, unicycle.heading);
    beside -= cross * cross.transpose() / variance;
  }
  return beside;
}

}  // namespace

std::vector<SurrogateStage> affine_surrogates(const PredictedMotion& motion, double core) {
  SurrogateRecursion recursion(motion, core);
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
                                     const std::vector<Eigen::Index>& axes) {
  // What a model error does of the past is not known.
  if (motion.model_error != nullptr || motion.belief_error != nullptr) {
    return motion.noise_covariance;
  }
  const std::optional<UnicycleStructure> unicycle = motion.dynamics.unicycle();
  const bool always_open = open_loop(motion.policy);
  const bool heading =
      unicycle && std::find(axes.begin(), axes.end(), unicycle->heading) != axes.end();
  // The last noise is independent of all that was before it.
  if (!unicycle || (heading && !always_open)) return motion.noise_covariance;
  // The position's error is made of the headings before the last step. Open loop nothing but their
  // own noise moves them; with feedback the position of stage k − 2 is the last that can, so that
  // the noise which came into that of k − 1 still is independent. Where the heading itself is
  // restricted, what moves it with the position must not count either.
  const std::vector<int> position = {unicycle->x, unicycle->y};
  const Eigen::Matrix2d noise = beside_heading(*unicycle, motion.noise_covariance);
  const Eigen::Matrix2d belief = beside_heading(*unicycle, motion.belief.covariance);
  Eigen::Matrix2d sum = motion.noise_covariance(position, position);
  if (heading) sum = noise;
  if (always_open) {
    sum += static_cast<double>(stage - 1) * noise + belief;
  } else {
    sum += stage == 1 ? belief : noise;
  }
  Eigen::MatrixXd smoothing =
      Eigen::MatrixXd::Zero(motion.noise_covariance.rows(), motion.noise_covariance.cols());
  smoothing(position, position) = sum;
  return smoothing;
}

}  // namespace qsmpc
