#include "models/dynamics/dubins_rk4_batch.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "models/dynamics/dubins_rk4_batch.cpp"
#include <hwy/foreach_target.h>

#include "models/simd/lanes-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace qsmpc::models {
namespace HWY_NAMESPACE {

/// The car's directions at the beginning, the middle and the end of the period. The latter two
/// follow by rotation, which takes one sine and cosine instead of two.
struct Directions {
  SineCosine begin;
  SineCosine middle;
  SineCosine end;
};

HWY_INLINE SineCosine turned(const SineCosine& direction, const SineCosine& angle) {
  SineCosine result = direction;
  result.sine = direction.sine * angle.cosine + direction.cosine * angle.sine;
  result.cosine = direction.cosine * angle.cosine - direction.sine * angle.sine;
  return result;
}

HWY_INLINE Directions directions(Vector heading, Vector half_turn) {
  const SineCosine angle = sine_cosine(half_turn);
  const SineCosine begin = sine_cosine(heading);
  const SineCosine middle = turned(begin, angle);
  return {.begin = begin, .middle = middle, .end = turned(middle, angle)};
}

void rk4_step(const DubinsRk4& car, const Dynamics::BatchView& states,
              const Dynamics::BatchView& inputs, Dynamics::BatchOut& next) {
  const Vector sixth = constant(car.speed * car.time_step / 6.0);
  const Vector period = constant(car.time_step);
  const Vector half = constant(0.5 * car.time_step);
  const Vector four = constant(4.0);
  const double* const x = states.row(DubinsRk4::kX).data();
  const double* const y = states.row(DubinsRk4::kY).data();
  const double* const heading = states.row(DubinsRk4::kHeading).data();
  const double* const yaw_rate = inputs.row(DubinsRk4::kYawRate).data();
  double* const next_x = next.row(DubinsRk4::kX).data();
  double* const next_y = next.row(DubinsRk4::kY).data();
  double* const next_heading = next.row(DubinsRk4::kHeading).data();
  for_vectors(states.cols(), [&](std::size_t i, auto load_at, auto store_at, std::size_t) HWY_ATTR {
    const Vector angle = load_at(heading + i);
    const Vector rate = load_at(yaw_rate + i);
    const Directions to = directions(angle, half * rate);
    const Vector along_x = (to.begin.cosine + to.end.cosine) + four * to.middle.cosine;
    const Vector along_y = (to.begin.sine + to.end.sine) + four * to.middle.sine;
    store_at(load_at(x + i) + sixth * along_x, next_x + i);
    store_at(load_at(y + i) + sixth * along_y, next_y + i);
    store_at(angle + period * rate, next_heading + i);
  });
}

// With e(φ) = (cos φ, sin φ), e' = (−sin φ, cos φ), a = vT and the adjoint p of the new position,
//
//     ∂/∂φ = (a/6) p·(e'₀ + 4 e'₁ + e'₂),    ∂/∂u = (aT/6) p·(2 e'₁ + e'₂),
//
// and the new heading adds its own adjoint to the former and T times it to the latter.
void rk4_pullback(const DubinsRk4& car, const Dynamics::BatchView& states,
                  const Dynamics::BatchView& inputs, const Dynamics::BatchView& next_adjoint,
                  Dynamics::BatchOut& state_adjoint, Dynamics::BatchOut& input_adjoint) {
  const Vector sixth = constant(car.speed * car.time_step / 6.0);
  const Vector period = constant(car.time_step);
  const Vector half = constant(0.5 * car.time_step);
  const Vector two = constant(2.0);
  const double* const heading = states.row(DubinsRk4::kHeading).data();
  const double* const yaw_rate = inputs.row(DubinsRk4::kYawRate).data();
  const double* const next_x = next_adjoint.row(DubinsRk4::kX).data();
  const double* const next_y = next_adjoint.row(DubinsRk4::kY).data();
  const double* const next_heading = next_adjoint.row(DubinsRk4::kHeading).data();
  double* const to_x = state_adjoint.row(DubinsRk4::kX).data();
  double* const to_y = state_adjoint.row(DubinsRk4::kY).data();
  double* const to_heading = state_adjoint.row(DubinsRk4::kHeading).data();
  double* const to_yaw_rate = input_adjoint.row(DubinsRk4::kYawRate).data();
  for_vectors(states.cols(), [&](std::size_t i, auto load_at, auto store_at, std::size_t) HWY_ATTR {
    const Directions to = directions(load_at(heading + i), half * load_at(yaw_rate + i));
    const Vector along_x = load_at(next_x + i);
    const Vector along_y = load_at(next_y + i);
    const Vector turn = load_at(next_heading + i);
    const Vector begin = along_y * to.begin.cosine - along_x * to.begin.sine;
    const Vector middle = two * (along_y * to.middle.cosine - along_x * to.middle.sine);
    const Vector end = along_y * to.end.cosine - along_x * to.end.sine;
    store_at(along_x, to_x + i);
    store_at(along_y, to_y + i);
    store_at(turn + sixth * ((begin + end) + two * middle), to_heading + i);
    store_at(period * (turn + sixth * (middle + end)), to_yaw_rate + i);
  });
}

}  // namespace HWY_NAMESPACE
}  // namespace qsmpc::models
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace qsmpc::models {

HWY_EXPORT(rk4_step);
HWY_EXPORT(rk4_pullback);

void step_dubins_rk4(const DubinsRk4& car, const Dynamics::BatchView& states,
                     const Dynamics::BatchView& inputs, Dynamics::BatchOut next) {
  HWY_DYNAMIC_DISPATCH(rk4_step)(car, states, inputs, next);
}

void pullback_dubins_rk4(const DubinsRk4& car, const Dynamics::BatchView& states,
                         const Dynamics::BatchView& inputs, const Dynamics::BatchView& next_adjoint,
                         Dynamics::BatchOut state_adjoint, Dynamics::BatchOut input_adjoint) {
  HWY_DYNAMIC_DISPATCH(rk4_pullback)
  (car, states, inputs, next_adjoint, state_adjoint, input_adjoint);
}

}  // namespace qsmpc::models
#endif
