#include "controller/regions/penalty_kernels.hpp"

#include <cmath>
#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "controller/regions/penalty_kernels.cpp"
#include <hwy/foreach_target.h>

#include "models/simd/lanes-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace qsmpc::controller {
namespace HWY_NAMESPACE {

using namespace models::HWY_NAMESPACE;

/// h of planning/cost/penalty.hpp, and its derivative.
struct Hinge {
  Vector value;
  Vector slope;
};

HWY_INLINE Hinge hinge(Vector signed_distance, Vector inverse_length) {
  const Vector ratio = signed_distance * inverse_length;
  const Vector short_of_one = constant(1.0) - ratio;
  const Mask far = hn::Ge(ratio, constant(1.0));
  const Mask outside = hn::Ge(ratio, zeros());
  const Vector value =
      hn::IfThenElse(outside, constant(0.5) * short_of_one * short_of_one, constant(0.5) - ratio);
  const Vector slope =
      hn::IfThenElse(outside, zeros() - short_of_one * inverse_length, zeros() - inverse_length);
  return {hn::IfThenZeroElse(far, value), hn::IfThenZeroElse(far, slope)};
}

HWY_INLINE Vector positive(Vector value) { return hn::Max(value, zeros()); }

/// Where a point is relative to an obstacle.
struct Relation {
  Vector squared;  // squared distance, if outside
  Vector depth;    // distance to the nearest face, if inside
  Vector nearest;  // index of that face's axis in the list of faces
  Vector outward;  // the sign of its normal
};

class SmoothPenaltyLoops {
 public:
  explicit SmoothPenaltyLoops(const PenaltyBatch& batch)
      : batch_(batch),
        size_(batch.range.end - batch.range.begin),
        stride_(batch.locations.cols()),
        x_(batch.locations.data() + batch.range.begin),
        weight_(batch.weights.data() + batch.range.begin),
        adjoint_(batch.adjoint.data() + batch.range.begin),
        inverse_length_(constant(1.0 / batch.length)) {}

  double wall(const AxisInterval& face) {
    const Vector scale = constant(batch_.scale);
    Sum sum;
    for_vectors(size_, [&](std::size_t i, auto load_at, auto store_at, std::size_t part) HWY_ATTR {
      const Vector x = coordinate(load_at, face.axis, i);
      const Hinge low = hinge(x - constant(face.lower), inverse_length_);
      const Hinge high = hinge(constant(face.upper) - x, inverse_length_);
      const Vector weight = scale * load_at(weight_ + i);
      sum.add(part, weight * (low.value + high.value));
      add(load_at, store_at, face.axis, i, weight * (low.slope - high.slope));
    });
    return sum.total();
  }

  double box(const std::vector<AxisInterval>& obstacle) {
    const VectorTag d;
    const Vector scale = constant(batch_.scale);
    Sum sum;
    for_vectors(size_, [&](std::size_t i, auto load_at, auto store_at, std::size_t part) HWY_ATTR {
      const Relation at = relation(obstacle, load_at, i);
      const Mask inside = hn::Eq(at.squared, zeros());
      const Vector distance = hn::Sqrt(at.squared);
      const Hinge value =
          hinge(hn::IfThenElse(inside, zeros() - at.depth, distance), inverse_length_);
      const Vector weight = scale * load_at(weight_ + i);
      sum.add(part, weight * value.value);
      // Most particles are far from most obstacles.
      if (hn::AllTrue(d, hn::Eq(value.slope, zeros()))) return;
      const Vector push = weight * value.slope;
      const Vector per_distance = push / distance;
      for (std::size_t k = 0; k < obstacle.size(); ++k) {
        const Vector x = coordinate(load_at, obstacle[k].axis, i);
        const Vector beyond =
            positive(x - constant(obstacle[k].upper)) - positive(constant(obstacle[k].lower) - x);
        const Mask nearest = hn::Eq(at.nearest, constant(static_cast<double>(k)));
        const Vector out = hn::IfThenElse(inside, hn::IfThenElseZero(nearest, push * at.outward),
                                          per_distance * beyond);
        add(load_at, store_at, obstacle[k].axis, i,
            hn::IfThenZeroElse(hn::Eq(value.slope, zeros()), out));
      }
    });
    return sum.total();
  }

 private:
  template <class LoadAt>
  HWY_INLINE Vector coordinate(const LoadAt& load_at, int axis, std::size_t i) const {
    return load_at(x_ + axis * stride_ + i);
  }

  template <class LoadAt, class StoreAt>
  HWY_INLINE void add(const LoadAt& load_at, const StoreAt& store_at, int axis, std::size_t i,
                      Vector value) {
    double* const at = adjoint_ + axis * stride_ + i;
    store_at(load_at(at) + value, at);
  }

  template <class LoadAt>
  HWY_INLINE Relation relation(const std::vector<AxisInterval>& obstacle, const LoadAt& load_at,
                               std::size_t i) const {
    Relation result{zeros(), constant(std::numeric_limits<double>::infinity()), zeros(), zeros()};
    for (std::size_t k = 0; k < obstacle.size(); ++k) {
      const Vector x = coordinate(load_at, obstacle[k].axis, i);
      const Vector below = x - constant(obstacle[k].lower);
      const Vector above = constant(obstacle[k].upper) - x;
      const Vector least = hn::Min(below, above);
      const Vector gap = positive(zeros() - least);
      result.squared = result.squared + gap * gap;
      const Mask nearer = hn::Lt(least, result.depth);
      result.depth = hn::IfThenElse(nearer, least, result.depth);
      result.nearest = hn::IfThenElse(nearer, constant(static_cast<double>(k)), result.nearest);
      result.outward = hn::IfThenElse(
          nearer, hn::IfThenElse(hn::Lt(below, above), constant(-1.0), constant(1.0)),
          result.outward);
    }
    return result;
  }

  const PenaltyBatch& batch_;
  std::size_t size_;
  Eigen::Index stride_;
  const double* x_;
  const double* weight_;
  double* adjoint_;
  Vector inverse_length_;
};

double wall_loop(const AxisInterval& bounds, const PenaltyBatch& batch) {
  return SmoothPenaltyLoops(batch).wall(bounds);
}

double box_loop(const std::vector<AxisInterval>& intervals, const PenaltyBatch& batch) {
  return SmoothPenaltyLoops(batch).box(intervals);
}

}  // namespace HWY_NAMESPACE
}  // namespace qsmpc::controller
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace qsmpc::controller {

HWY_EXPORT(wall_loop);
HWY_EXPORT(box_loop);

double wall_penalty(const AxisInterval& bounds, const PenaltyBatch& batch) {
  return HWY_DYNAMIC_DISPATCH(wall_loop)(bounds, batch);
}

double box_penalty(const std::vector<AxisInterval>& intervals, const PenaltyBatch& batch) {
  return HWY_DYNAMIC_DISPATCH(box_loop)(intervals, batch);
}

}  // namespace qsmpc::controller
#endif  // HWY_ONCE
