// The smooth penalties of the bounds (penalty.hpp), in expectation over the laws that particles
// represent.
//
// A hundred particles reach only some two standard deviations from their mean, while a plan's cost
// near a wall may arise farther out. So a particle represents more than its place: along each
// coordinate, with the stepped particles f_i, their mean m and variance v, and the noise's standard
// deviation σ, the law of the next state is taken to be
//
//     m + θ (f_i − m) + √(σ² + (1 − θ²) v) z   with probability ρ_i,   z ~ N(0, 1):
//
// a smoothed particle measure (West 1993; Liu and West 2001), whose mean m and variance v + σ² do
// not depend on θ. With θ = 1 it is the mixture of the particles' noise. As h is quadratic, then
// linear, the expectation has a closed form (docs/theory/planning.md). The gradient accounts for m
// and v being functions of the particles.
#pragma once

#include <vector>

#include <Eigen/Core>

#include "controller/measure/measures.hpp"
#include "controller/parallel.hpp"
#include "controller/planning/cost/bounds_kernels.hpp"
#include "controller/planning/cost/penalty.hpp"
#include "controller/regions/safe_set.hpp"

namespace qsmpc::controller {

/// 1 − θ² for `count` particles in `dim` dimensions that have been through a compression:
/// min(1, b²) with b = 1.5 count^(−1/(dim + 4)). The rate is that of kernel density estimation
/// (Scott 1992), so that predictions converge as the number grows; the factor is from measurements
/// (docs/theory/planning.md).
[[nodiscard]] double smoothing_of(Eigen::Index count, Eigen::Index dim);

class ExpectedBounds {
 public:
  /// For penalties that are not smooth, or have no weight, the object is empty.
  ExpectedBounds(const Box& bounds, const Penalty& penalty);

  [[nodiscard]] bool empty() const { return bounds_.empty(); }

  struct Law {
    const Eigen::VectorXd& noise_deviation;  ///< d; σ
    double smoothing = 0.0;                  ///< 1 − θ², within 0 … 1
  };

  /// Σ_i weights_i E h over all faces of the bounds for particles `points` (d x n), whose weights
  /// sum to one; the gradient is added to `gradient` (d x n). NaN where a point is not finite. The
  /// result does not depend on `run`; allocates only when the number of particles is larger than
  /// ever before.
  double add(const Law& law, const Points& points, const Eigen::VectorXd& weights,
             const Executor& run, Points& gradient);

 private:
  /// One bounded coordinate, for the current particles.
  struct Coordinate {
    double mean = 0.0;
    SmoothedCoordinate law;
    FaceCorrection correction;
    bool near = true;  ///< whether any particle is near enough to be penalised
  };
  template <class Action>
  void for_near(const Executor& run, const Points& points, const Action& action) const;
  void describe(const Law& law, const Points& points);

  Penalty penalty_;
  std::vector<AxisInterval> bounds_;
  std::vector<Coordinate> coordinates_;     // as bounds_
  std::vector<CoordinateMoments> moments_;  // chunks x bounds
  std::vector<FaceCost> face_costs_;        // chunks x bounds
};

}  // namespace qsmpc::controller
