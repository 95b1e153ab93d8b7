// One step of the closed loop near a Gaussian: its affine approximation, and bounds on the
// difference. Derivation: docs/theory/surrogate.md.
#pragma once

#include <array>
#include <vector>

#include <Eigen/Core>

#include "controller/certification/higher_order_norms.hpp"
#include "controller/certification/saturation.hpp"
#include "controller/certification/stage_error.hpp"
#include "controller/measure/measures.hpp"
#include "controller/prediction/prediction.hpp"
#include "controller/regions/safe_set.hpp"

namespace qsmpc::controller {

/// The affine map z ↦ next_mean + transition (z − m) about the law N(m, S) of a stage, and the
/// residual r(x) = f(x, u(x)) − map(x).
struct StatisticalLinearisation {
  Eigen::MatrixXd transition;  ///< A, n x n
  Eigen::VectorXd next_mean;   ///< n
  /// Bounds on r(z), z in the core, the mean square without `closed_form`; and on |r(x)| over the
  /// region.
  StageError residual;
  Eigen::VectorXd closed_form;  ///< n, √E[…²] of the unicycle's part of r(z); else zero
  Eigen::MatrixXd growth;  ///< n x n: |g_i(x) − g_i(z)| ≤ Σ_a growth_ia |x_a − z_a|, g the step
  Eigen::MatrixXd stretch;  ///< n x n: |r_i(x) − r_i(z)| ≤ Σ_a stretch_ia |x_a − z_a| + …
  Eigen::MatrixXd input_gain;  ///< n x m: … + Σ_b input_gain_ib |q_b(x) − q_b(z)|
  Box region;                  ///< the core widened by |x − z|; infinite in affine coordinates
  double outside = 0.0;        ///< bounds P(z not in the core)
};

/// One input's feedback under the law of a stage.
struct InputLinearisation {
  double mean = 0.0;       ///< of v + K (z − x̄), before the clamp
  double deviation = 0.0;  ///< of the same
  SaturationFit saturation;
  double difference = 0.0;  ///< bounds √E[(q(x) − q(z))²; inside], q the clamp's residual
  std::array<double, kHigherOrders.size()> higher_residual{};    ///< bounds ‖q(z)‖_p
  std::array<double, kHigherOrders.size()> higher_difference{};  ///< ‖q(x) − q(z)‖_p inside
};

/// The inputs' fits at stage `stage` about `law`; `error` bounds x − z before the step.
[[nodiscard]] std::vector<InputLinearisation> linearise_inputs(const PredictedMotion& motion,
                                                               Eigen::Index stage,
                                                               const Gaussian& law,
                                                               const StageError& error);

/// For each coordinate of (x, u), whether f is affine in it with constant coefficients everywhere.
[[nodiscard]] std::vector<bool> affine_coordinates(const models::Dynamics& dynamics);

/// The shape of a core: the affine coordinates of (x, u), from `affine_coordinates`, which it does
/// not restrict, and its half-width in standard deviations. A wide core is hardly ever left (4e-8
/// in each coordinate); a narrow one (5e-4) has smaller residuals where deviations are large.
struct CoreShape {
  std::vector<bool> affine;
  double reach;
};

inline constexpr double kWideCore = 5.5;
inline constexpr double kNarrowCore = 3.5;

/// The fit of stage `stage`; law and error as above.
[[nodiscard]] StatisticalLinearisation linearise_stage(
    const PredictedMotion& motion, Eigen::Index stage, const Gaussian& law, const StageError& error,
    const std::vector<InputLinearisation>& inputs, const CoreShape& core);

}  // namespace qsmpc::controller
