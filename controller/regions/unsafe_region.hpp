// A part of the unsafe set, and what planning, certification and drawing ask of it. A shape is a
// class that answers, and a line in the table of shapes (unsafe_set.hpp).
//
// Every question takes the stage, 0 being the present, so that regions may move. Regions are
// closed: touching one is unsafe.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "controller/measure/measures.hpp"
#include "controller/measure/normal/norm_orders.hpp"
#include "controller/parallel.hpp"
#include "controller/regions/tail_sum.hpp"

#pragma GCC visibility push(default)

namespace qsmpc::controller {

/// Particles that a penalty is taken at, and what it is like: scale · h(signed distance / length),
/// with h of planning/cost/penalty.hpp.
struct PenaltyBatch {
  const Points& locations;         ///< state_dim x n
  const Eigen::VectorXd& weights;  ///< n
  ParticleRange range;             ///< those that are meant
  double scale = 1.0;
  double length = 1.0;  ///< > 0
  Points& adjoint;      ///< state_dim x n
};

/// The state as bounds C3 and C4 know it (docs/theory/surrogate.md): z + e with z ~ law.
struct SurrogateLaw {
  const Gaussian& law;
  const Eigen::VectorXd& error;  ///< bounds of √E e_a², state_dim
  const HigherNorms& higher;     ///< bounds of ‖e_a‖_p for p in kHigherOrders
  /// Covariance of a part of z that is independent of z less it and of e's given coordinates.
  const std::function<Eigen::MatrixXd(const std::vector<Eigen::Index>& axes)>& smoothing;
  /// What a bound that is no more need not be worked out further.
  double worthwhile = 0.0;
};

/// Upper bounds of probabilities, to which each region adds its own.
struct RegionProbability {
  double markov = 0.0;  ///< C3
  double smooth = 0.0;  ///< C4; what a region adds is never above what it adds to C3

  RegionProbability& operator+=(const RegionProbability& other) {
    markov += other.markov;
    smooth += other.smooth;
    return *this;
  }
};

/// {x: normal · x ≥ offset}
struct HalfSpace {
  Eigen::VectorXd normal;  ///< state_dim
  double offset = 0.0;
};

/// Signed distances of points, with their derivatives: unit vectors that lead away fastest.
struct NearestFaces {
  Eigen::ArrayXd distance;  ///< n
  Points slope;             ///< state_dim x n
};

/// Gaussians of one covariance about many centres.
struct GaussianCentres {
  const Points& centres;  ///< state_dim x n, all finite
  const Eigen::MatrixXd& covariance;
  const Eigen::VectorXd& lowest;   ///< of the centres, coordinate by coordinate
  const Eigen::VectorXd& highest;  ///< the same
};

/// A region as Gaussians about some centres see it: what does not depend on the reach t.
class SoftRegion {
 public:
  virtual ~SoftRegion() = default;
  /// Adds at least E(1 − d(y_i, region)²/t²)₊, y_i about centre begin + i, to totals[i], i < count
  /// ≤ kSoftBlock. t > 0.
  virtual void add(double t, Eigen::Index begin, Eigen::Index count, double* totals) const = 0;
};

/// The most centres that a SoftRegion is asked about at once.
inline constexpr Eigen::Index kSoftBlock = 64;

/// A region in the plane of two coordinates, for drawing.
struct Outline {
  Eigen::Matrix2Xd corners;        ///< of a polygon, in turn; entries may be infinite
  bool unsafe_inside = true;       ///< else what is outside is unsafe
  bool depends_on_others = false;  ///< whether it is unsafe for some of the other coordinates only
};

class UnsafeRegion {
 public:
  virtual ~UnsafeRegion() = default;

  /// Euclidean distance to the region outside of it; inside, minus the least distance that leads
  /// out. For C1 and C2 this is the distance that an error has to bridge.
  [[nodiscard]] virtual double signed_distance(
      Eigen::Index stage, const Eigen::Ref<const Eigen::VectorXd>& point) const = 0;
  /// Lowers least[i] to the signed distance of points.col(i) where that is less. What is lowered
  /// for a point that is not finite is not specified.
  virtual void lower_to_distances(Eigen::Index stage, const Points& points,
                                  Eigen::ArrayXd& least) const = 0;

  /// The same with the derivatives, which are overwritten where a distance is lowered. On an edge
  /// or in a middle, where there are several, it is one of them.
  virtual void lower_to_faces(Eigen::Index stage, const Points& points,
                              NearestFaces& nearest) const = 0;

  /// Σ weights · penalty over the range; its gradient is added to the adjoint there.
  virtual double add_penalty(Eigen::Index stage, const PenaltyBatch& batch) const = 0;

  /// Adds upper bounds of P(z + e in the region).
  virtual void add_probability(Eigen::Index stage, const SurrogateLaw& state,
                               RegionProbability& sum) const = 0;
  /// Adds the tails of the region's convex parts: smooth, for optimisation, and no bound.
  virtual void add_tail(Eigen::Index stage, const Gaussian& law, TailSum& sum) const = 0;
  /// At least E(1 − d(y, region)²/t²)₊ for y ~ N(mean, covariance); t > 0. It may be the sum over
  /// parts, and more than 1.
  [[nodiscard]] virtual double soft_probability(Eigen::Index stage,
                                                const Eigen::Ref<const Eigen::VectorXd>& mean,
                                                const Eigen::Ref<const Eigen::MatrixXd>& covariance,
                                                double t) const = 0;
  /// The same for many; refers to the region and the centres.
  [[nodiscard]] virtual std::unique_ptr<const SoftRegion> soften(
      Eigen::Index stage, const GaussianCentres& centres) const = 0;

  /// Half-spaces that together hold the region: its own where it is made of such, else the one with
  /// the normal `towards` (state_dim). As many at every stage, in the same order; none at one where
  /// no direction ends the region, or where it is uncertain where it is.
  [[nodiscard]] virtual std::vector<HalfSpace> half_space_cover(
      Eigen::Index stage, const Eigen::Ref<const Eigen::VectorXd>& towards) const = 0;

  /// In the plane of coordinates x and y, -1 standing for one that the system lacks.
  [[nodiscard]] virtual Outline outline(Eigen::Index stage, Eigen::Index x,
                                        Eigen::Index y) const = 0;
};

}  // namespace qsmpc::controller

#pragma GCC visibility pop
