// How a discrete measure takes up one step's noise and is brought back to a fixed number of points.
//
// A step is x⁺ = f(x, u) + w. The stepped points f_i are combined with the points of the noise
// quantiser and compressed (Eq. 4-5, 4-6). With the assignment of products to clusters held, this
// is a sparse affine map of the stepped points, c̃ = A f + b, because the noise is additive: it is
// built once and then costs a few multiplications a point, forwards and backwards, exactly.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "controller/measure/gaussian_quantiser.hpp"
#include "controller/measure/measures.hpp"

namespace qsmpc {

/// c̃_n = Σ_i A_ni f_i + b_n, with the weights of the c̃_n.
struct StageMap {
  std::vector<int> row_begin;       ///< clusters + 1; row n is [row_begin[n], row_begin[n + 1])
  std::vector<int> column;          ///< index i of each entry
  std::vector<double> coefficient;  ///< A_ni of each entry; each row sums to one
  Points offset;                    ///< b, d x clusters
  Eigen::VectorXd weights;          ///< clusters
  double compression_w2 = 0.0;      ///< cost of the coupling from the products to the clusters

  [[nodiscard]] Eigen::Index clusters() const { return weights.size(); }
};

/// out = A stepped + b. stepped: d x sources, out: d x clusters (both sized by the caller).
void apply_stage_map(const StageMap& map, const Points& stepped, Points& out);

/// Reverse mode of `apply_stage_map`: stepped_adjoint = Aᵀ adjoint (overwritten).
void pullback_stage_map(const StageMap& map, const Points& adjoint, Points& stepped_adjoint);

class Propagator {
 public:
  virtual ~Propagator() = default;

  /// The map that takes up the noise and compresses, with the assignments that suit `stepped`
  /// (d x n; weights: n). Points that are not finite give a map of infinite compression_w2, never
  /// an exception.
  [[nodiscard]] virtual StageMap stage_map(const Points& stepped,
                                           const Eigen::VectorXd& weights) const = 0;

  /// W2 between the noise and the discrete measure that stands for it in the map.
  [[nodiscard]] virtual double noise_w2() const = 0;
};

struct PropagatorSettings {
  Gaussian noise;               ///< zero mean
  int noise_points = 100;       ///< budget of the noise quantiser
  int compressed_points = 100;  ///< points kept after a step
};

struct PropagatorEntry {
  std::string name;
  std::string summary;
};

/// The table of propagators: "compressed" (product with the noise quantiser, then compression) and
/// "noise_free" (only the belief is propagated; the noise counts fully as error).
[[nodiscard]] const std::vector<PropagatorEntry>& propagators();

/// Throws std::invalid_argument on an unknown name or senseless settings.
[[nodiscard]] std::unique_ptr<const Propagator> make_propagator(std::string_view name,
                                                                const PropagatorSettings& settings);

}  // namespace qsmpc
