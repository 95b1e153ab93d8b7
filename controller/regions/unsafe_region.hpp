// A part of the unsafe set: the queries that planning, certification and drawing make. A new shape
// takes a class that implements them and a line in the table of shapes (unsafe_set.hpp).
//
// Every query takes the stage, 0 being the present, so that regions may move. Regions are closed:
// touching one is unsafe.
#pragma once

#include <algorithm>
#include <cmath>
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

/// Particles at which a penalty is evaluated, and its parameters: the penalty is scale · h(signed
/// distance / length), with h of planning/cost/penalty.hpp.
struct PenaltyBatch {
  const Points& locations;         ///< state_dim x n
  const Eigen::VectorXd& weights;  ///< n
  ParticleRange range;             ///< the particles to evaluate
  double scale = 1.0;
  double length = 1.0;  ///< > 0
  Points& adjoint;      ///< state_dim x n
};

/// Which of the bounds C3 and C4 are wanted.
enum class WantedBounds {
  kBoth,
  kLeast,  ///< C4 alone; C3 only as far as it may lower C4, and a looser one otherwise
};

/// The state in bounds C3 and C4 (docs/theory/surrogate.md): z + e with z ~ law.
struct SurrogateLaw {
  const Gaussian& law;
  const Eigen::VectorXd& error;  ///< bounds of √E e_a², state_dim
  const HigherNorms& higher;     ///< bounds of ‖e_a‖_p for p in kHigherOrders
  /// Covariance of a part n of z that is independent of z − n and of e in the given coordinates.
  const std::function<Eigen::MatrixXd(const std::vector<Eigen::Index>& axes)>& smoothing;
  /// A bound at or below this value need not be refined.
  double worthwhile = 0.0;
  WantedBounds wanted = WantedBounds::kBoth;
  /// With kLeast: a greater bound is of no use, since one this low is known already, and need not
  /// be found.
  double useful = 1.0;
};

/// Upper bounds of probabilities; each region adds its own.
struct RegionProbability {
  double markov = 0.0;  ///< C3
  double smooth = 0.0;  ///< C4; a region never adds more to it than to C3

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

/// Signed distances of points and their gradients: unit vectors of steepest increase.
struct NearestFaces {
  Eigen::ArrayXd distance;  ///< n
  Points slope;             ///< state_dim x n
};

/// Gaussians of one covariance about many centres.
struct GaussianCentres {
  const Points& centres;  ///< state_dim x n, all finite
  const Eigen::MatrixXd& covariance;
  const Eigen::VectorXd& lowest;   ///< minimum over the centres, by coordinate
  const Eigen::VectorXd& highest;  ///< maximum over the centres, by coordinate
};

/// A region prepared for Gaussians about given centres: everything that does not depend on the
/// reach t.
class SoftRegion {
 public:
  virtual ~SoftRegion() = default;
  /// Adds an upper bound of E(1 − d(y_i, region)²/t²)₊ to totals[i] for each i < count ≤
  /// kSoftBlock, y_i being the Gaussian about centre begin + i. t > 0.
  virtual void add(double t, Eigen::Index begin, Eigen::Index count, double* totals) const = 0;
};

/// The largest number of centres in one call of SoftRegion::add.
inline constexpr Eigen::Index kSoftBlock = 64;

/// A region in the plane of two coordinates, for drawing.
struct Outline {
  Eigen::Matrix2Xd corners;        ///< of a polygon, in order; entries may be infinite
  bool unsafe_inside = true;       ///< otherwise the outside is unsafe
  bool depends_on_others = false;  ///< whether it is unsafe only for some values of the others
};

class UnsafeRegion {
 public:
  virtual ~UnsafeRegion() = default;

  /// Outside the region, the Euclidean distance to it; inside, minus the least distance out of it.
  /// For C1 and C2 this is the distance that an error has to bridge.
  [[nodiscard]] virtual double signed_distance(
      Eigen::Index stage, const Eigen::Ref<const Eigen::VectorXd>& point) const = 0;
  /// Lowers least[i] to the signed distance of points.col(i) where that is less. The result for a
  /// point that is not finite is unspecified.
  virtual void lower_to_distances(Eigen::Index stage, const Points& points,
                                  Eigen::ArrayXd& least) const = 0;

  /// The same with the gradients, which are overwritten where a distance is lowered. Where the
  /// gradient is not unique, at an edge or midway between faces, it is one of those possible.
  virtual void lower_to_faces(Eigen::Index stage, const Points& points,
                              NearestFaces& nearest) const = 0;

  /// Σ weights · penalty over the range; its gradient is added to the adjoint there.
  virtual double add_penalty(Eigen::Index stage, const PenaltyBatch& batch) const = 0;

  /// Adds upper bounds of P(z + e in the region).
  virtual void add_probability(Eigen::Index stage, const SurrogateLaw& state,
                               RegionProbability& sum) const = 0;
  /// Adds the tails of the region's convex parts: smooth, for optimisation; not a bound.
  virtual void add_tail(Eigen::Index stage, const Gaussian& law, TailSum& sum) const = 0;
  /// A distance by which the law's mean may be moved before a tail may be added; 0 if one may be
  /// added already.
  [[nodiscard]] virtual double distance_without_tail(Eigen::Index stage,
                                                     const Gaussian& law) const {
    const double reach = kNoTail * std::sqrt(law.covariance.trace());
    return std::max(0.0, signed_distance(stage, law.mean) - reach);
  }
  /// An upper bound of E(1 − d(y, region)²/t²)₊ for y ~ N(mean, covariance); t > 0. It may be a sum
  /// over parts and exceed 1.
  [[nodiscard]] virtual double soft_probability(Eigen::Index stage,
                                                const Eigen::Ref<const Eigen::VectorXd>& mean,
                                                const Eigen::Ref<const Eigen::MatrixXd>& covariance,
                                                double t) const = 0;
  /// The same for many centres; the result keeps references to the region and the centres.
  [[nodiscard]] virtual std::unique_ptr<const SoftRegion> soften(
      Eigen::Index stage, const GaussianCentres& centres) const = 0;

  /// Half-spaces whose union contains the region: its own if it consists of half-spaces, otherwise
  /// the one with the normal `towards` (state_dim). Their number and order are the same at every
  /// stage, except that there are none at a stage at which no such half-space contains the region
  /// or its place is uncertain.
  [[nodiscard]] virtual std::vector<HalfSpace> half_space_cover(
      Eigen::Index stage, const Eigen::Ref<const Eigen::VectorXd>& towards) const = 0;

  /// Outline in the plane of coordinates x and y; -1 stands for a coordinate that the system lacks.
  [[nodiscard]] virtual Outline outline(Eigen::Index stage, Eigen::Index x,
                                        Eigen::Index y) const = 0;
};

}  // namespace qsmpc::controller

#pragma GCC visibility pop
