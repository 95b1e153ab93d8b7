// One stage's noise and compression as an affine map of the stepped points.
//
// With the assignment of products to clusters fixed, the new points are c̃ = A f + b with A sparse
// and constant, because the noise is additive. Once built, the map is exact and costs a few
// multiplications per point, forwards and backwards. The points may then be spread about their
// mean, by a matrix that is also fixed, to restore the covariance lost by quantisation and
// compression (docs/theory/quantisation.md).
#pragma once

#include <Eigen/Core>

#include "controller/measure/measures.hpp"
#include "controller/prediction/sparse_matrix.hpp"

#pragma GCC visibility push(default)

namespace qsmpc::controller {

/// c̃_n = m + S (Σ_i A_ni f_i + b_n − m), with the weights ρ̃_n of the c̃_n and their mean
/// m = Σ_n ρ̃_n (Σ_i A_ni f_i + b_n).
struct StageMap {
  bool identity = false;    ///< A = I, b = 0: the points stay as they are, and `shares` is empty
  SparseMatrix shares;      ///< A, clusters x sources; each row sums to one
  Points offset;            ///< b, d x clusters
  Eigen::VectorXd weights;  ///< clusters
  Eigen::MatrixXd spread;   ///< S, d x d, symmetric; empty: the identity
  double compression_w2 = 0.0;  ///< cost of the coupling from the products to the c̃_n

  [[nodiscard]] Eigen::Index clusters() const { return weights.size(); }
};

/// out = c̃. stepped: d x sources, out: d x clusters (both sized by the caller).
void apply_stage_map(const StageMap& map, const Points& stepped, Points& out);

/// The same without the spread, for the clusters begin … end − 1, and from packed points (unused if
/// the map is the identity): lets several threads share the work.
void apply_shares(const StageMap& map, const Points& stepped, const PackedPoints& packed,
                  Eigen::Index begin, Eigen::Index end, Points& out);

/// Applies the spread to the points of `out`, which are the means of their clusters.
void apply_spread(const StageMap& map, Points& out);

/// Reverse mode of `apply_stage_map`, with A, b, S and the weights held: `stepped_adjoint`
/// (d x sources) is overwritten by the transpose of the linear part, applied to `adjoint`.
void pullback_stage_map(const StageMap& map, const Points& adjoint, Points& stepped_adjoint);

/// Its two parts: overwrites the adjoint of the spread points by that of the clusters' means, …
void pullback_spread(const StageMap& map, Points& adjoint);

/// … and writes the adjoint of the stepped points begin … end − 1, from `adjoint`, which is also
/// passed in packed form. `transposed` is the transpose of map.shares; like the packed form, it is
/// not used if the map is the identity.
void pullback_shares(const StageMap& map, const SparseMatrix& transposed, const Points& adjoint,
                     const PackedPoints& packed, Eigen::Index begin, Eigen::Index end,
                     Points& stepped_adjoint);

}  // namespace qsmpc::controller

#pragma GCC visibility pop
