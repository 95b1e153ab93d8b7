#include "controller/planning/cost/bounds_kernels.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "controller/planning/cost/bounds_kernels.cpp"
#include <hwy/foreach_target.h>

#include "controller/measure/normal/normal_cdf-inl.hpp"
#include "models/simd/lanes-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace qsmpc::controller {
namespace HWY_NAMESPACE {

using namespace models::HWY_NAMESPACE;

/// E h(r + s z) for a ratio r = distance/ℓ, its derivative by r, and that by s, divided by s.
struct SmoothedHinge {
  Vector value;
  Vector slope;
  Vector widening;
};

/// E(m + s z)²₊, half its derivative by m, and half that by s, divided by s, for standard normal z
/// and s > 0: with a = m/s, (m² + s²) Φ(a) + m s φ(a), m Φ(a) + s φ(a) and Φ(a).
struct SquaredHinge {
  Vector value;
  Vector half_slope;
  Vector probability;
};

HWY_INLINE SquaredHinge squared_hinge_of_normal(Vector mean, Vector spread) {
  const NormalValues normal = normal_values(mean / spread);
  const Vector half_slope = mean * normal.probability + spread * normal.density;
  return {mean * half_slope + spread * spread * normal.probability, half_slope, normal.probability};
}

/// With t = 1 − r, h = ½ t²₊ − ½ (t − 1)²₊. Most particles are far from most faces, and most of the
/// others are far from where h becomes linear; terms that vanish are skipped.
HWY_INLINE SmoothedHinge hinge_of_normal(Vector ratio, Vector spread) {
  const VectorTag d;
  const Vector t = constant(1.0) - ratio;
  const Vector reach = constant(kFarDeviations) * spread;
  // NaN does not count as far.
  if (hn::AllTrue(d, hn::Lt(t, zeros() - reach))) return {zeros(), zeros(), zeros()};
  const SquaredHinge whole = squared_hinge_of_normal(t, spread);
  SquaredHinge beyond{zeros(), zeros(), zeros()};
  if (!hn::AllTrue(d, hn::Lt(t - constant(1.0), zeros() - reach))) {
    beyond = squared_hinge_of_normal(t - constant(1.0), spread);
  }
  const Mask far = hn::Lt(t, zeros() - reach);
  const Mask deep = hn::Gt(t - constant(1.0), reach);
  const Vector value = constant(0.5) * (whole.value - beyond.value);
  const Vector slope = beyond.half_slope - whole.half_slope;
  // Far away, squares may overflow; deep inside, h is linear.
  return {hn::IfThenZeroElse(far, hn::IfThenElse(deep, t - constant(0.5), value)),
          hn::IfThenZeroElse(far, hn::IfThenElse(deep, constant(-1.0), slope)),
          whole.probability - beyond.probability};
}

CoordinateMoments moments_loop(const double* x, const double* weights, std::size_t size,
                               double reference) {
  const Vector r = constant(reference);
  Sum first;
  Sum second;
  Vector least = zeros();
  Vector most = zeros();
  for_vectors(size, [&](std::size_t i, auto load_at, auto, std::size_t part) HWY_ATTR {
    const Vector weight = load_at(weights + i);
    // Padding elements have zero weight.
    const Vector away = hn::IfThenZeroElse(hn::Eq(weight, zeros()), load_at(x + i) - r);
    const Vector weighted = weight * away;
    first.add(part, weighted);
    second.add(part, weighted * away);
    least = hn::Min(least, away);
    most = hn::Max(most, away);
  });
  const VectorTag d;
  return {first.total(), second.total(), hn::GetLane(hn::MinOfLanes(d, least)),
          hn::GetLane(hn::MaxOfLanes(d, most))};
}

FaceCost face_cost_loop(const AxisInterval& bounds, const SmoothedCoordinate& law, double scale,
                        double length, const double* x, const double* weights, std::size_t size,
                        double* gradient) {
  const Vector inverse_length = constant(1.0 / length);
  const Vector spread = constant(law.deviation / length);
  const Vector share = constant(law.share);
  const Vector offset = constant(law.offset);
  const Vector lower = constant(bounds.lower);
  const Vector upper = constant(bounds.upper);
  const Vector factor = constant(scale);
  Sum value;
  Sum by_offset;
  Sum by_variance;
  for_vectors(size, [&](std::size_t i, auto load_at, auto store_at, std::size_t part) HWY_ATTR {
    const Vector at = share * load_at(x + i) + offset;
    const SmoothedHinge low = hinge_of_normal((at - lower) * inverse_length, spread);
    const SmoothedHinge high = hinge_of_normal((upper - at) * inverse_length, spread);
    const Vector weight = factor * load_at(weights + i);
    const Vector slope = weight * inverse_length * (low.slope - high.slope);
    value.add(part, weight * (low.value + high.value));
    by_offset.add(part, slope);
    by_variance.add(part, weight * (low.widening + high.widening));
    store_at(load_at(gradient + i) + share * slope, gradient + i);
  });
  return {value.total(), by_offset.total(), by_variance.total() / (length * length)};
}

void correct_loop(const FaceCorrection& correction, const double* x, const double* weights,
                  std::size_t size, double* gradient) {
  const Vector at_zero = constant(correction.constant);
  const Vector linear = constant(correction.linear);
  for_vectors(size, [&](std::size_t i, auto load_at, auto store_at, std::size_t) HWY_ATTR {
    const Vector added = load_at(weights + i) * (at_zero + linear * load_at(x + i));
    store_at(load_at(gradient + i) + added, gradient + i);
  });
}

}  // namespace HWY_NAMESPACE
}  // namespace qsmpc::controller
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace qsmpc::controller {

HWY_EXPORT(moments_loop);
HWY_EXPORT(face_cost_loop);
HWY_EXPORT(correct_loop);

CoordinateMoments coordinate_moments(const double* x, const double* weights, std::size_t size,
                                     double reference) {
  return HWY_DYNAMIC_DISPATCH(moments_loop)(x, weights, size, reference);
}

FaceCost evaluate_faces(const AxisInterval& bounds, const SmoothedCoordinate& law,
                        const Penalty& penalty, const double* x, const double* weights,
                        std::size_t size, double* gradient) {
  return HWY_DYNAMIC_DISPATCH(face_cost_loop)(bounds, law, penalty.box, penalty.length, x, weights,
                                              size, gradient);
}

void correct_gradient(const FaceCorrection& correction, const double* x, const double* weights,
                      std::size_t size, double* gradient) {
  HWY_DYNAMIC_DISPATCH(correct_loop)(correction, x, weights, size, gradient);
}

}  // namespace qsmpc::controller
#endif
