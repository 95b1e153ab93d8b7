// How a discrete measure takes up one step's noise and is brought back to a fixed number of points.
//
// A step is x⁺ = f(x, u) + w. The stepped points f_i are combined with the points of the noise
// quantiser and compressed (Eq. 4-5, 4-6). With the assignment of products to clusters held, this
// is a sparse affine map of the stepped points, c̃ = A f + b, because the noise is additive: it is
// built once and then costs a few multiplications a point, forwards and backwards, exactly. The
// points may then be spread about their mean, by a matrix that is held as well, to restore the
// covariance that quantisation and compression have lost (docs/theory/quantisation.md).
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "controller/measure/gaussian_quantiser.hpp"
#include "controller/measure/measures.hpp"

namespace qsmpc {

/// c̃_n = m + S (Σ_i A_ni f_i + b_n − m), with the weights ρ̃_n of the c̃_n and their mean
/// m = Σ_n ρ̃_n (Σ_i A_ni f_i + b_n).
struct StageMap {
  std::vector<int> row_begin;       ///< clusters + 1; row n is [row_begin[n], row_begin[n + 1])
  std::vector<int> column;          ///< index i of each entry
  std::vector<double> coefficient;  ///< A_ni of each entry; each row sums to one
  Points offset;                    ///< b, d x clusters
  Eigen::VectorXd weights;          ///< clusters
  Eigen::MatrixXd spread;           ///< S, d x d, symmetric; empty: the identity
  double compression_w2 = 0.0;      ///< cost of the coupling from the products to the c̃_n

  [[nodiscard]] Eigen::Index clusters() const { return weights.size(); }
};

/// out = c̃. stepped: d x sources, out: d x clusters (both sized by the caller).
void apply_stage_map(const StageMap& map, const Points& stepped, Points& out);

/// Reverse mode of `apply_stage_map`, with A, b, S and the weights held: `stepped_adjoint`
/// (d x sources) is overwritten by the transpose of the linear part, applied to `adjoint`.
void pullback_stage_map(const StageMap& map, const Points& adjoint, Points& stepped_adjoint);

class Propagator {
 public:
  virtual ~Propagator() = default;

  /// The map that takes up the noise and compresses, with the assignments that suit `stepped`
  /// (d x n; weights: n). Points that are not finite give a map of infinite compression_w2, never
  /// an exception.
  [[nodiscard]] virtual StageMap stage_map(const Points& stepped,
                                           const Eigen::VectorXd& weights) const = 0;

  /// W2 between the noise and the discrete measure that stands for it in the map, or a bound on it.
  [[nodiscard]] virtual double noise_w2() const = 0;
};

struct PropagatorSettings {
  Gaussian noise;               ///< zero mean
  int noise_points = 100;       ///< budget of the noise quantiser
  int compressed_points = 100;  ///< points kept after a step
  int refinements = 3;          ///< of the compression (`compress`), in "moment_matched" only
  double sharpness = 20.0;      ///< β of Algorithm 1, in one over the state's unit; "soft" only
};

struct PropagatorEntry {
  std::string name;
  std::string summary;
};

/// The table of propagators: "compressed" (product with the noise quantiser, then compression by
/// the split tree alone), "moment_matched" (the same with Lloyd's noise quantiser and refined
/// compression, spread to the covariance of the stepped points plus that of the noise), "soft" (as
/// "compressed", with the soft assignments of Algorithm 1) and "noise_free" (only the belief is
/// propagated; the noise counts fully as error).
[[nodiscard]] const std::vector<PropagatorEntry>& propagators();

/// Throws std::invalid_argument on an unknown name or senseless settings.
[[nodiscard]] std::unique_ptr<const Propagator> make_propagator(std::string_view name,
                                                                const PropagatorSettings& settings);

}  // namespace qsmpc
