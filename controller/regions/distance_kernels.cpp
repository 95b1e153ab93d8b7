#include "controller/regions/distance_kernels.hpp"

#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "controller/regions/distance_kernels.cpp"
#include <hwy/foreach_target.h>

#include "models/simd/lanes-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace qsmpc::controller {
namespace HWY_NAMESPACE {

using namespace models::HWY_NAMESPACE;

/// Where points are relative to a box.
struct BoxRelation {
  Vector depth;    // distance to the nearest face inside; negative outside
  Vector squared;  // squared distance, outside
};

template <class LoadAt>
HWY_INLINE BoxRelation relation_to(const std::vector<AxisInterval>& intervals, const double* x,
                                   Eigen::Index stride, const LoadAt& load_at, std::size_t i) {
  BoxRelation result{constant(std::numeric_limits<double>::infinity()), zeros()};
  for (const AxisInterval& interval : intervals) {
    const Vector at = load_at(x + interval.axis * stride + i);
    const Vector above_lower = at - constant(interval.lower);
    const Vector below_upper = constant(interval.upper) - at;
    const Vector inside = hn::Min(above_lower, below_upper);
    const Vector beyond = hn::Max(zeros() - inside, zeros());
    result.depth = hn::Min(result.depth, inside);
    result.squared = result.squared + beyond * beyond;
  }
  return result;
}

void wall_distances(const std::vector<AxisInterval>& intervals, const Points& points,
                    double* least) {
  for_vectors(points.cols(), [&](std::size_t i, auto load_at, auto store_at, std::size_t) HWY_ATTR {
    const BoxRelation at = relation_to(intervals, points.data(), points.cols(), load_at, i);
    const Vector distance =
        hn::IfThenElse(hn::Gt(at.depth, zeros()), at.depth, zeros() - hn::Sqrt(at.squared));
    store_at(hn::Min(load_at(least + i), distance), least + i);
  });
}

void box_distances(const std::vector<AxisInterval>& intervals, double radius, const Points& points,
                   double* least) {
  for_vectors(points.cols(), [&](std::size_t i, auto load_at, auto store_at, std::size_t) HWY_ATTR {
    const BoxRelation at = relation_to(intervals, points.data(), points.cols(), load_at, i);
    const Vector distance =
        hn::IfThenElse(hn::Ge(at.depth, zeros()), zeros() - at.depth, hn::Sqrt(at.squared));
    store_at(hn::Min(load_at(least + i), distance - constant(radius)), least + i);
  });
}

}  // namespace HWY_NAMESPACE
}  // namespace qsmpc::controller
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace qsmpc::controller {

HWY_EXPORT(wall_distances);
HWY_EXPORT(box_distances);

void lower_to_wall_distances(const std::vector<AxisInterval>& intervals, const Points& points,
                             Eigen::ArrayXd& least) {
  HWY_DYNAMIC_DISPATCH(wall_distances)(intervals, points, least.data());
}

void lower_to_box_distances(const std::vector<AxisInterval>& intervals, double radius,
                            const Points& points, Eigen::ArrayXd& least) {
  HWY_DYNAMIC_DISPATCH(box_distances)(intervals, radius, points, least.data());
}

}  // namespace qsmpc::controller
#endif  // HWY_ONCE
