#include "controller/certification/statistical_linearisation.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "controller/certification/unicycle_fit.hpp"
#include "controller/measure/normal/normal_distribution.hpp"
#include "models/constants.hpp"

namespace qsmpc::controller {
namespace {
/// z = (x, u): the box of a stage and how far its points are from the centre of the expansion.
struct Neighbourhood {
  Eigen::VectorXd lower;
  Eigen::VectorXd upper;
  Eigen::VectorXd reach;  ///< bounds |z_a − centre_a|; infinite in affine coordinates
};

/// Second moments of ξ = (x − m, u − E u) under the law, inputs before their clamp: shift and
/// covariance of the Gaussian that dominates each coordinate.
struct Moments {
  Eigen::VectorXd shift;
  Eigen::MatrixXd covariance;

  /// √E[X_a² X_b²] of two jointly Gaussian variables (Isserlis).
  [[nodiscard]] double root_of_product(Eigen::Index a, Eigen::Index b) const {
    const double cross = covariance(a, b);
    const double square =
        (shift[a] * shift[a] + covariance(a, a)) * (shift[b] * shift[b] + covariance(b, b)) +
        2.0 * cross * cross + 4.0 * shift[a] * shift[b] * cross;
    return std::sqrt(std::max(0.0, square));
  }

  /// Upper bound of ‖X_a‖_2p, p = kHigherOrders[k].
  [[nodiscard]] double norm(Eigen::Index a, std::size_t k) const {
    const double deviation = std::sqrt(std::max(0.0, covariance(a, a)));
    return std::abs(shift[a]) + deviation * higher_order_norms(k).first_twice;
  }
};

/// ½ Σ_ab most_ab ‖X_a‖_2p ‖X_b‖_2p bounds ‖½ ξᵀHξ‖_p (Minkowski, Hölder).
double quadratic_norm(const Eigen::MatrixXd& most, const Moments& moments, std::size_t k) {
  Eigen::VectorXd norms(most.rows());
  for (Eigen::Index a = 0; a < most.rows(); ++a) norms[a] = moments.norm(a, k);
  return 0.5 * norms.dot(most * norms);
}

Neighbourhood neighbourhood(const PredictedMotion& motion, const Gaussian& law,
                            const StageError& error, const Eigen::MatrixXd& gain,
                            const std::vector<InputLinearisation>& inputs, const CoreShape& core) {
  const auto largest = error.largest();
  const Eigen::Index states = law.mean.size();
  const Eigen::Index total = states + static_cast<Eigen::Index>(inputs.size());
  Neighbourhood near{Eigen::VectorXd(total), Eigen::VectorXd(total), Eigen::VectorXd(total)};
  for (Eigen::Index a = 0; a < states; ++a) {
    near.reach[a] = core.affine[a]
                        ? kInfinity
                        : core.reach * std::sqrt(std::max(0.0, law.covariance(a, a))) + largest[a];
    near.lower[a] = law.mean[a] - near.reach[a];
    near.upper[a] = law.mean[a] + near.reach[a];
  }
  for (std::size_t b = 0; b < inputs.size(); ++b) {
    const Eigen::Index a = states + static_cast<Eigen::Index>(b);
    const InputLinearisation& input = inputs[b];
    const double span = core.reach * input.deviation +
                        gain.row(static_cast<Eigen::Index>(b)).cwiseAbs().dot(largest);
    const double least = motion.policy.bounds.lower[static_cast<Eigen::Index>(b)];
    const double most = motion.policy.bounds.upper[static_cast<Eigen::Index>(b)];
    const double centre = input.saturation.mean;
    near.lower[a] = std::min(centre, std::clamp(input.mean - span, least, most));
    near.upper[a] = std::max(centre, std::clamp(input.mean + span, least, most));
    near.reach[a] = std::max(centre - near.lower[a], near.upper[a] - centre);
  }
  return near;
}

Moments moments_of(const Gaussian& law, const Eigen::MatrixXd& gain,
                   const std::vector<InputLinearisation>& inputs) {
  const Eigen::Index states = law.mean.size();
  const Eigen::Index count = gain.rows();
  Moments moments{Eigen::VectorXd::Zero(states + count),
                  Eigen::MatrixXd(states + count, states + count)};
  const Eigen::MatrixXd cross = law.covariance * gain.transpose();
  moments.covariance.topLeftCorner(states, states) = law.covariance;
  moments.covariance.topRightCorner(states, count) = cross;
  moments.covariance.bottomLeftCorner(count, states) = cross.transpose();
  moments.covariance.bottomRightCorner(count, count) = gain * cross;
  for (Eigen::Index b = 0; b < count; ++b) {
    moments.shift[states + b] = inputs[b].mean - inputs[b].saturation.mean;
  }
  return moments;
}

/// The remainder of one component beyond the affine map, from its second derivatives.
struct Curvature {
  double offset = 0.0;    ///< of the map
  double residual = 0.0;  ///< bounds the root mean square
  double largest = 0.0;   ///< bounds the absolute value over the neighbourhood
  std::array<double, kHigherOrders.size()> higher{};  ///< bounds the norms of higher order
};

/// ½ ξᵀH(·)ξ − offset with H between `lower` and `upper`: taken about zero, or, with H₀ the middle
/// of the states' block, about ½ tr(H₀S), where √Var(½ ξᵀH₀ξ) = √(½ tr (H₀S)²) is exact and only
/// the rest is bounded entry by entry; the better of the two.
Curvature curvature_of(const Eigen::MatrixXd& lower, const Eigen::MatrixXd& upper,
                       const Gaussian& law, const Moments& moments, const Eigen::VectorXd& reach) {
  const Eigen::Index states = law.mean.size();
  const Eigen::MatrixXd most = lower.cwiseAbs().cwiseMax(upper.cwiseAbs());
  if (most.isZero(0.0)) return {};
  Curvature about_zero;
  double rest = 0.0;
  double spread = 0.0;
  for (Eigen::Index a = 0; a < most.rows(); ++a) {
    for (Eigen::Index b = 0; b < most.cols(); ++b) {
      if (most(a, b) == 0.0) continue;
      const double root = moments.root_of_product(a, b);
      const bool middle = a < states && b < states;
      about_zero.residual += 0.5 * most(a, b) * root;
      rest += 0.5 * (middle ? 0.5 * (upper(a, b) - lower(a, b)) : most(a, b)) * root;
      spread += 0.5 * most(a, b) * reach[a] * reach[b];
    }
  }
  about_zero.largest = spread;
  const Eigen::MatrixXd product =
      0.5 * (lower + upper).topLeftCorner(states, states) * law.covariance;
  Curvature centred{
      .offset = 0.5 * product.trace(),
      .residual =
          std::sqrt(std::max(0.0, 0.5 * product.cwiseProduct(product.transpose()).sum())) + rest,
      .largest = spread + std::abs(0.5 * product.trace())};
  Curvature& better = centred.residual < about_zero.residual ? centred : about_zero;
  for (std::size_t k = 0; k < kHigherOrders.size(); ++k) {
    better.higher[k] = quadratic_norm(most, moments, k) + std::abs(better.offset);
  }
  return better;
}

/// Entrywise, the largest difference from `value` of a matrix within the bounds.
Eigen::MatrixXd deviation(const Eigen::MatrixXd& lower, const Eigen::MatrixXd& upper,
                          const Eigen::MatrixXd& value) {
  return (upper - value).cwiseMax(value - lower).cwiseMax(0.0);
}

/// Largest absolute value of every entry of ∂f/∂x + ∂f/∂u diag(s) K over the bounds and all slopes
/// 0 ≤ s ≤ 1 of the clamp.
Eigen::MatrixXd closed_loop_growth(const models::DerivativeBounds& bounds,
                                   const Eigen::MatrixXd& gain) {
  const Eigen::Index states = gain.cols();
  Eigen::MatrixXd lower = bounds.jacobian_lower.leftCols(states);
  Eigen::MatrixXd upper = bounds.jacobian_upper.leftCols(states);
  for (Eigen::Index b = 0; b < gain.rows(); ++b) {
    const Eigen::MatrixXd low = bounds.jacobian_lower.col(states + b) * gain.row(b);
    const Eigen::MatrixXd high = bounds.jacobian_upper.col(states + b) * gain.row(b);
    lower += low.cwiseMin(high).cwiseMin(0.0);
    upper += low.cwiseMax(high).cwiseMax(0.0);
  }
  return lower.cwiseAbs().cwiseMax(upper.cwiseAbs());
}

/// Fits the step of any system by the bounds of its derivatives over the neighbourhood (Taylor's
/// formula).
void fit_by_derivatives(const PredictedMotion& motion, const Gaussian& law,
                        const Eigen::MatrixXd& gain, const std::vector<InputLinearisation>& inputs,
                        const Neighbourhood& near, StatisticalLinearisation& fit) {
  const Eigen::Index states = law.mean.size();
  const Eigen::Index count = gain.rows();
  models::StateBatch centre = law.mean;
  models::StateBatch input(count, 1);
  Eigen::VectorXd slopes(count);
  for (Eigen::Index b = 0; b < count; ++b) {
    input(b, 0) = inputs[b].saturation.mean;
    slopes[b] = inputs[b].saturation.slope;
  }
  models::StateBatch next(states, 1);
  motion.dynamics.step(centre, input, next);
  Eigen::MatrixXd by_state(states, states);
  Eigen::MatrixXd by_input(states, count);
  motion.dynamics.jacobians(centre.col(0), input.col(0), by_state, by_input);
  const models::DerivativeBounds bounds = motion.dynamics.derivative_bounds(near.lower, near.upper);
  const Moments moments = moments_of(law, gain, inputs);

  fit.transition = by_state + by_input * slopes.asDiagonal() * gain;
  fit.input_gain = by_input.cwiseAbs();
  fit.next_mean = next.col(0);
  for (Eigen::Index i = 0; i < states; ++i) {
    const Curvature curvature =
        curvature_of(bounds.hessian_lower[i], bounds.hessian_upper[i], law, moments, near.reach);
    fit.next_mean[i] += curvature.offset;
    fit.residual.mean_square()[i] = curvature.residual;
    fit.residual.largest()[i] = curvature.largest;
    for (std::size_t k = 0; k < kHigherOrders.size(); ++k) {
      fit.residual.higher(k)[i] = curvature.higher[k];
    }
  }
  Eigen::MatrixXd jacobian(states, states + count);
  jacobian << by_state, by_input;
  const Eigen::MatrixXd off = deviation(bounds.jacobian_lower, bounds.jacobian_upper, jacobian);
  fit.stretch = off.leftCols(states) + off.rightCols(count) * gain.cwiseAbs();
  fit.growth = closed_loop_growth(bounds, gain);
}

/// P(z outside of the core): two tails for every coordinate and input that the core restricts.
double outside_core(const Gaussian& law, const std::vector<InputLinearisation>& inputs,
                    const CoreShape& core) {
  const double tails = 2.0 * normal_cumulative(-core.reach);
  double sum = 0.0;
  for (Eigen::Index a = 0; a < law.mean.size(); ++a) {
    if (!core.affine[a] && law.covariance(a, a) > 0.0) sum += tails;
  }
  for (const InputLinearisation& input : inputs) {
    if (input.deviation > 0.0) sum += tails;
  }
  return sum;
}

/// |q(x) − q(z)| is (1 − slope)|K(x − z)| where neither is clamped, and never more than
/// max(slope, 1 − slope)|K(x − z)|; either is clamped only where z's feedback is within `largest`
/// of a bound. norm: that of K(x − z), of order `order`, like the result.
double clamp_difference(const InputLinearisation& input, double norm, double largest,
                        double clamped, int order) {
  const double slope = input.saturation.slope;
  const double anywhere = std::max(slope, 1.0 - slope) * norm;
  if (!(input.deviation > 0.0) || !std::isfinite(largest)) return anywhere;
  const double near_bound = std::min(norm, largest * std::pow(clamped, 1.0 / order));
  return std::min(anywhere, (1.0 - slope) * norm + near_bound);
}

/// P(v + K(z − x̄) is within `margin` of a bound or beyond it).
double probability_near_bounds(const InputLinearisation& input, double margin, double lower,
                               double upper) {
  if (!(input.deviation > 0.0)) return 1.0;
  return std::min(1.0, normal_cumulative((lower + margin - input.mean) / input.deviation) +
                           normal_cumulative((input.mean + margin - upper) / input.deviation));
}

}  // namespace

std::vector<InputLinearisation> linearise_inputs(const PredictedMotion& motion, Eigen::Index stage,
                                                 const Gaussian& law, const StageError& error) {
  const Policy& policy = motion.policy;
  const Eigen::MatrixXd& gain = policy.gains[stage];
  std::vector<InputLinearisation> inputs(gain.rows());
  for (Eigen::Index b = 0; b < gain.rows(); ++b) {
    InputLinearisation& input = inputs[b];
    const double lower = policy.bounds.lower[b];
    const double upper = policy.bounds.upper[b];
    const Eigen::VectorXd row = gain.row(b).transpose();
    input.mean = policy.inputs(b, stage) + row.dot(law.mean - policy.states.col(stage));
    input.deviation = std::sqrt(std::max(0.0, row.dot(law.covariance * row)));
    input.saturation = fit_saturation(input.mean, input.deviation, lower, upper);
    const Eigen::VectorXd sizes = row.cwiseAbs();
    const double largest = sizes.dot(error.largest());
    const double clamped = probability_near_bounds(input, largest, lower, upper);
    input.difference = clamp_difference(input, sizes.dot(error.mean_square()), largest, clamped, 2);
    input.higher_residual =
        saturation_residual_norms(input.saturation, input.mean, input.deviation, lower, upper);
    for (std::size_t k = 0; k < kHigherOrders.size(); ++k) {
      input.higher_difference[k] =
          clamp_difference(input, sizes.dot(error.higher(k)), largest, clamped, kHigherOrders[k]);
    }
  }
  return inputs;
}

std::vector<bool> affine_coordinates(const models::Dynamics& dynamics) {
  const int states = dynamics.state_dim();
  const int total = states + dynamics.input_dim();
  const models::DerivativeBounds bounds = dynamics.derivative_bounds(
      Eigen::VectorXd::Constant(total, -kInfinity), Eigen::VectorXd::Constant(total, kInfinity));
  std::vector<bool> affine(total, true);
  for (int a = 0; a < total; ++a) {
    for (int i = 0; i < states; ++i) {
      if (!bounds.hessian_lower[i].row(a).isZero(0.0) ||
          !bounds.hessian_upper[i].row(a).isZero(0.0)) {
        affine[a] = false;
      }
    }
  }
  return affine;
}

StatisticalLinearisation linearise_stage(const PredictedMotion& motion, Eigen::Index stage,
                                         const Gaussian& law, const StageError& error,
                                         const std::vector<InputLinearisation>& inputs,
                                         const CoreShape& core) {
  const Eigen::MatrixXd& gain = motion.policy.gains[stage];
  const Eigen::Index states = law.mean.size();
  const Neighbourhood near = neighbourhood(motion, law, error, gain, inputs, core);
  StatisticalLinearisation fit;
  fit.residual = StageError::none(states);
  fit.closed_form = Eigen::VectorXd::Zero(states);
  fit.region = {.lower = near.lower.head(states), .upper = near.upper.head(states)};
  fit.outside = outside_core(law, inputs, core);
  if (const std::optional<models::UnicycleStructure> unicycle = motion.dynamics.unicycle()) {
    fit_unicycle(*unicycle, law,
                 {.gain = gain.row(unicycle->input),
                  .saturation = inputs[unicycle->input].saturation,
                  .away = near.reach[unicycle->heading]},
                 gain.rows(), fit);
  } else {
    fit_by_derivatives(motion, law, gain, inputs, near, fit);
  }
  for (Eigen::Index b = 0; b < gain.rows(); ++b) {
    const InputLinearisation& input = inputs[b];
    const double span = core.reach * input.deviation + gain.row(b).cwiseAbs().dot(error.largest());
    const double worst =
        largest_saturation_residual(input.saturation, input.mean, span,
                                    motion.policy.bounds.lower[b], motion.policy.bounds.upper[b]);
    const auto by_input = fit.input_gain.col(b);
    fit.residual.mean_square() += by_input * input.saturation.residual;
    fit.residual.largest() += by_input * worst;
    for (std::size_t k = 0; k < kHigherOrders.size(); ++k) {
      fit.residual.higher(k) += by_input * input.higher_residual[k];
    }
  }
  return fit;
}

}  // namespace qsmpc::controller
