#include "controller/planning/cost/printed_penalty.hpp"

#include <cmath>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "controller/planning/cost/printed_penalty.cpp"
#include <hwy/foreach_target.h>

#include "models/simd/lanes-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace qsmpc::controller {
namespace HWY_NAMESPACE {

using namespace models::HWY_NAMESPACE;

/// A distance, and its derivative by the coordinate.
struct Excess {
  Vector value;
  Vector slope;
};

HWY_INLINE Vector positive(Vector value) { return hn::Max(value, zeros()); }

class PrintedPenaltyLoops {
 public:
  PrintedPenaltyLoops(const TermBatch& batch, double scale)
      : size_(batch.range.end - batch.range.begin),
        stride_(batch.points.cols()),
        x_(batch.points.data() + batch.range.begin),
        weight_(batch.weights.data() + batch.range.begin),
        adjoint_(batch.gradient.data() + batch.range.begin),
        scale_(scale) {}

  double bound(const AxisInterval& face) {
    const Vector scale = constant(scale_);
    Sum sum;
    for_vectors(size_, [&](std::size_t i, auto load_at, auto store_at, std::size_t part) HWY_ATTR {
      const Vector x = coordinate(load_at, face.axis, i);
      const Excess out = excess(face, x);
      const Vector weight = scale * load_at(weight_ + i);
      // x − x propagates NaN, which the comparisons would lose.
      sum.add(part, weight * (out.value + (x - x)));
      add(load_at, store_at, face.axis, i, weight * out.slope);
    });
    return sum.total();
  }

  double obstacles(const std::vector<std::vector<AxisInterval>>& obstacles) {
    const Vector scale = constant(scale_);
    Sum sum;
    for_vectors(size_, [&](std::size_t i, auto load_at, auto store_at, std::size_t part) HWY_ATTR {
      Vector largest = zeros();
      Vector at = constant(-1.0);
      for (std::size_t n = 0; n < obstacles.size(); ++n) {
        Vector outside = zeros();
        for (const AxisInterval& face : obstacles[n]) {
          outside = outside + excess(face, coordinate(load_at, face.axis, i)).value;
        }
        const Vector indicator = constant(1.0) - hn::Min(outside, constant(1.0));
        const Mask larger = hn::Gt(indicator, largest);
        largest = hn::IfThenElse(larger, indicator, largest);
        at = hn::IfThenElse(larger, constant(static_cast<double>(n)), at);
      }
      const Vector weight = scale * load_at(weight_ + i);
      sum.add(part, weight * largest);
      for (std::size_t n = 0; n < obstacles.size(); ++n) {
        const Mask chosen = hn::Eq(at, constant(static_cast<double>(n)));
        for (const AxisInterval& face : obstacles[n]) {
          const Vector slope = excess(face, coordinate(load_at, face.axis, i)).slope;
          add(load_at, store_at, face.axis, i,
              hn::IfThenElseZero(chosen, zeros() - weight * slope));
        }
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

  /// Distance of x outside the face's interval, and its derivative (Eq. 4-10).
  HWY_INLINE Excess excess(const AxisInterval& face, Vector x) const {
    const Vector below = positive(constant(face.lower) - x);
    const Vector above = positive(x - constant(face.upper));
    return {below + above,
            hn::IfThenElse(hn::Gt(above, zeros()), constant(1.0),
                           hn::IfThenElseZero(hn::Gt(below, zeros()), constant(-1.0)))};
  }

  std::size_t size_;
  Eigen::Index stride_;
  const double* x_;
  const double* weight_;
  double* adjoint_;
  double scale_;
};

double bounds_loop(const std::vector<AxisInterval>& bounds, double scale, const TermBatch& batch) {
  PrintedPenaltyLoops loops(batch, scale);
  double value = 0.0;
  for (const AxisInterval& interval : bounds) value += loops.bound(interval);
  return value;
}

double obstacles_loop(const std::vector<std::vector<AxisInterval>>& obstacles, double scale,
                      const TermBatch& batch) {
  return PrintedPenaltyLoops(batch, scale).obstacles(obstacles);
}

}  // namespace HWY_NAMESPACE
}  // namespace qsmpc::controller
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace qsmpc::controller {

HWY_EXPORT(bounds_loop);
HWY_EXPORT(obstacles_loop);

double printed_bounds_penalty(const std::vector<AxisInterval>& bounds, double scale,
                              const TermBatch& batch) {
  return HWY_DYNAMIC_DISPATCH(bounds_loop)(bounds, scale, batch);
}

double printed_obstacle_penalty(const std::vector<std::vector<AxisInterval>>& obstacles,
                                double scale, const TermBatch& batch) {
  return HWY_DYNAMIC_DISPATCH(obstacles_loop)(obstacles, scale, batch);
}

}  // namespace qsmpc::controller
#endif  // HWY_ONCE
