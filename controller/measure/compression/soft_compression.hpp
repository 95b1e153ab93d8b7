// Soft compression (Algorithm 1): every point belongs to all clusters, more strongly to nearer
// ones.
#pragma once

#include <Eigen/Core>

#include "controller/measure/measures.hpp"

namespace qsmpc::controller {

/// Clusters with fractional membership of the points, and the measure of the clusters' means.
struct SoftCompression {
  DiscreteMeasure measure;           ///< one point per cluster: its mean and mass
  Eigen::MatrixXd responsibilities;  ///< n x N, w_in ≥ 0, each row sums to one
  double w2 = 0.0;  ///< √Σ_i ρ_i Σ_n w_in |c_i − c̃_n|², the cost of the coupling ρ_i w_in: a bound
  Eigen::MatrixXd within_covariance;  ///< d x d, Σ ρ_i w_in (c_i − c̃_n)(c_i − c̃_n)ᵀ: what is lost
  bool converged = false;             ///< whether the centres settled within the allowed rounds
};

struct SoftCompressionSettings {
  int count = 1;            ///< largest number of clusters
  double sharpness = 1.0;   ///< β > 0, in one over the unit of the locations
  int rounds = 100;         ///< largest number in Algorithm 1's loop, at least 1
  double tolerance = 1e-9;  ///< settled when no centre moves by more than this share of the spread
};

/// Algorithm 1: c̃_n = Σ ρ_i w_in c_i / ρ̃_n, ρ̃_n = Σ ρ_i w_in, where
/// w_in = exp(−β |c_i − c̃_n|) / Σ_m exp(−β |c_i − c̃_m|), repeated. It starts from `compress`
/// without refinements instead of at random, so that it is deterministic.
///
/// Mass and mean are kept exactly (up to rounding), whatever β is. But the clusters approach those
/// of `compress` only as β grows; where 1/β is no smaller than the distances between centres, all
/// centres collapse to the mean and the covariance is lost. `w2` shows this: it is the cost of a
/// coupling, so it bounds the 2-Wasserstein distance from above, and its square is the trace of the
/// lost covariance. Takes O(n N) memory, and O(n N) time per round. Throws std::invalid_argument if
/// count or rounds < 1, sharpness is not positive and finite, tolerance is negative or not finite,
/// or as check_measure.
[[nodiscard]] SoftCompression compress_soft(const DiscreteMeasure& measure,
                                            const SoftCompressionSettings& settings);

}  // namespace qsmpc::controller
