// Mixtures of Gaussians with fewer components: repeatedly merges the pair whose merging changes the
// density least.
#pragma once

#include "controller/laws/stage_law.hpp"

namespace qsmpc::controller {

/// `mixture` with at most `components` ≥ 1 components, by Runnalls' algorithm: the pair that is
/// merged next has the least bound
///   B(i, j) = ½ [(w_i + w_j) log|P_ij| − w_i log|P_i| − w_j log|P_j|]
/// of the Kullback-Leibler divergence of the mixture from the one with the pair merged, P_ij being
/// the covariance of the merged pair. Mean and covariance of the mixture are kept.
/// (Runnalls: "Kullback-Leibler approach to Gaussian mixture reduction", IEEE Transactions on
/// Aerospace and Electronic Systems 43, 2007.) Where covariances are singular, a share of 1e-12 of
/// the mixture's is added to each before determinants are taken.
[[nodiscard]] GaussianMixture reduce_mixture(GaussianMixture mixture, int components);

}  // namespace qsmpc::controller
