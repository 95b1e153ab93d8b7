// The conditional value at risk of a sample, smoothed.
#pragma once

#include <Eigen/Core>

namespace qsmpc::controller {

/// min_t t + (1/(δ n)) Σ_i s(loss_i − t), where s is max(0, ·) rounded off over h = `smoothing` on
/// either side, s(y) = (y + h)²/4h for |y| < h. As h → 0 this is the conditional value at risk of
/// Rockafellar and Uryasev ("Optimization of conditional value-at-risk", 2000), which it exceeds by
/// at most h/4δ. `weights` (n) becomes its derivative by the losses. losses: finite; risk δ in (0,
/// 1); smoothing h > 0.
double smoothed_cvar(const Eigen::Ref<const Eigen::ArrayXd>& losses, double risk, double smoothing,
                     Eigen::ArrayXd& weights);

}  // namespace qsmpc::controller
