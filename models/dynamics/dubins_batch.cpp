#include "models/dynamics/dubins_batch.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "models/dynamics/dubins_batch.cpp"
#include <hwy/foreach_target.h>

#include "models/simd/lanes-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace qsmpc::models {
namespace HWY_NAMESPACE {

void dubins_step(const Dubins& car, const Dynamics::BatchView& states,
                 const Dynamics::BatchView& inputs, Dynamics::BatchOut& next) {
  const Vector reach = constant(car.speed * car.time_step);
  const Vector period = constant(car.time_step);
  const double* const x = states.row(Dubins::kX).data();
  const double* const y = states.row(Dubins::kY).data();
  const double* const heading = states.row(Dubins::kHeading).data();
  const double* const yaw_rate = inputs.row(Dubins::kYawRate).data();
  double* const next_x = next.row(Dubins::kX).data();
  double* const next_y = next.row(Dubins::kY).data();
  double* const next_heading = next.row(Dubins::kHeading).data();
  for_vectors(states.cols(), [&](std::size_t i, auto load_at, auto store_at, std::size_t) HWY_ATTR {
    const Vector angle = load_at(heading + i);
    const SineCosine direction = sine_cosine(angle);
    store_at(load_at(x + i) + reach * direction.cosine, next_x + i);
    store_at(load_at(y + i) + reach * direction.sine, next_y + i);
    store_at(angle + period * load_at(yaw_rate + i), next_heading + i);
  });
}

void dubins_pullback(const Dubins& car, const Dynamics::BatchView& states,
                     const Dynamics::BatchView& next_adjoint, Dynamics::BatchOut& state_adjoint,
                     Dynamics::BatchOut& input_adjoint) {
  const Vector reach = constant(car.speed * car.time_step);
  const Vector period = constant(car.time_step);
  const double* const heading = states.row(Dubins::kHeading).data();
  const double* const next_x = next_adjoint.row(Dubins::kX).data();
  const double* const next_y = next_adjoint.row(Dubins::kY).data();
  const double* const next_heading = next_adjoint.row(Dubins::kHeading).data();
  double* const to_x = state_adjoint.row(Dubins::kX).data();
  double* const to_y = state_adjoint.row(Dubins::kY).data();
  double* const to_heading = state_adjoint.row(Dubins::kHeading).data();
  double* const to_yaw_rate = input_adjoint.row(Dubins::kYawRate).data();
  for_vectors(states.cols(), [&](std::size_t i, auto load_at, auto store_at, std::size_t) HWY_ATTR {
    const SineCosine direction = sine_cosine(load_at(heading + i));
    const Vector along_x = load_at(next_x + i);
    const Vector along_y = load_at(next_y + i);
    const Vector turned = load_at(next_heading + i);
    store_at(along_x, to_x + i);
    store_at(along_y, to_y + i);
    store_at(turned + reach * (along_y * direction.cosine - along_x * direction.sine),
             to_heading + i);
    store_at(period * turned, to_yaw_rate + i);
  });
}

}  // namespace HWY_NAMESPACE
}  // namespace qsmpc::models
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace qsmpc::models {

HWY_EXPORT(dubins_step);
HWY_EXPORT(dubins_pullback);

void step_dubins(const Dubins& car, const Dynamics::BatchView& states,
                 const Dynamics::BatchView& inputs, Dynamics::BatchOut next) {
  HWY_DYNAMIC_DISPATCH(dubins_step)(car, states, inputs, next);
}

void pullback_dubins(const Dubins& car, const Dynamics::BatchView& states,
                     const Dynamics::BatchView& next_adjoint, Dynamics::BatchOut state_adjoint,
                     Dynamics::BatchOut input_adjoint) {
  HWY_DYNAMIC_DISPATCH(dubins_pullback)(car, states, next_adjoint, state_adjoint, input_adjoint);
}

}  // namespace qsmpc::models
#endif
