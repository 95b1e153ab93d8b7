// How a discrete measure absorbs one step's noise and is reduced to a fixed number of points again.
//
// A step is x⁺ = f(x, u) + w. The stepped points f_i are combined with the noise, which is either
// quantised (Eq. 4-5, 4-6) or kept Gaussian, and compressed. The result is a map of the stepped
// points that can be applied again with its assignments fixed (stage_map.hpp).
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "controller/measure/measures.hpp"
#include "controller/measure/quantisation/gaussian_quantiser.hpp"
#include "controller/parallel.hpp"
#include "controller/prediction/stage_map.hpp"

#pragma GCC visibility push(default)

namespace qsmpc::controller {

class Propagator {
 public:
  virtual ~Propagator() = default;

  /// Writes the map that adds the noise and compresses, with assignments chosen for `stepped`
  /// (d x n; weights: n), to `out`, whose storage is reused. Non-finite points give a map of
  /// infinite compression_w2, never an exception.
  virtual void update(const Points& stepped, const Eigen::VectorXd& weights, const Executor& run,
                      StageMap& out) = 0;

  /// The same map, returned by value.
  [[nodiscard]] StageMap stage_map(const Points& stepped, const Eigen::VectorXd& weights);

  /// W2 between the noise and the discrete measure that represents it in the map, or a bound on it.
  [[nodiscard]] virtual double noise_w2() const = 0;
};

struct PropagatorSettings {
  Gaussian noise;               ///< zero mean
  int noise_points = 100;       ///< budget of the noise quantiser; in "mixture", parts per source
  int compressed_points = 100;  ///< points kept after a step
  int refinements = 3;          ///< of the compression (`compress`), in "moment_matched" only
  double sharpness = 20.0;      ///< β of Algorithm 1, in one over the state's unit; "soft" only
};

/// One propagator. A new one takes a class and a line in the table.
struct PropagatorEntry {
  std::string name;
  std::string summary;
  std::unique_ptr<Propagator> (*make)(const PropagatorSettings& settings) = nullptr;
  bool carries_noise = true;  ///< whether the propagated points include the noise
};

/// The table of propagators: "mixture" (the noise stays Gaussian; its mixture about the stepped
/// points is cut into cells, whose means are displaced to match the mixture's covariance),
/// "compressed" (product with the noise quantiser, then compression by the split tree alone),
/// "moment_matched" (the same with Lloyd's noise quantiser and refined compression, spread to the
/// covariance of the stepped points plus that of the noise), "soft" (as "compressed", with the soft
/// assignments of Algorithm 1) and "noise_free" (only the belief is propagated; the noise counts
/// fully as error).
[[nodiscard]] const std::vector<PropagatorEntry>& propagators();

/// Throws std::invalid_argument on an unknown name.
[[nodiscard]] const PropagatorEntry& propagator_entry(std::string_view name);

/// Throws std::invalid_argument on an unknown name or invalid settings.
[[nodiscard]] std::unique_ptr<Propagator> make_propagator(std::string_view name,
                                                          const PropagatorSettings& settings);

}  // namespace qsmpc::controller

#pragma GCC visibility pop
