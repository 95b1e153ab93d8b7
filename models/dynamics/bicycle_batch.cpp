#include "models/dynamics/bicycle_batch.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "models/dynamics/bicycle_batch.cpp"
#include <hwy/foreach_target.h>

#include "models/simd/lanes-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace qsmpc::models {
namespace HWY_NAMESPACE {

/// The constants of Bicycle::step in all lanes, and the functions of a state that both directions
/// need.
struct BicycleVectors {
  explicit BicycleVectors(const Bicycle& car)
      : period(constant(car.time_step)),
        mass(constant(car.mass)),
        inertia(constant(car.yaw_inertia)),
        axle_sum(constant(-car.time_step * (car.front_tyre_stiffness + car.rear_tyre_stiffness))),
        moment_sum(
            constant(-car.time_step *
                     (car.front_axle_distance * car.front_axle_distance * car.front_tyre_stiffness +
                      car.rear_axle_distance * car.rear_axle_distance * car.rear_tyre_stiffness))),
        coupling(constant(car.time_step * (car.front_axle_distance * car.front_tyre_stiffness -
                                           car.rear_axle_distance * car.rear_tyre_stiffness))),
        lateral_kick(constant(-car.time_step * car.front_tyre_stiffness / car.mass)),
        yaw_kick(constant(-car.time_step * car.front_axle_distance * car.front_tyre_stiffness /
                          car.yaw_inertia)) {}

  Vector period;
  Vector mass;
  Vector inertia;
  Vector axle_sum;
  Vector moment_sum;
  Vector coupling;
  Vector lateral_kick;
  Vector yaw_kick;
};

void bicycle_step(const Bicycle& car, const Dynamics::BatchView& states,
                  const Dynamics::BatchView& inputs, Dynamics::BatchOut& next) {
  const BicycleVectors k(car);
  const std::size_t in = states.outerStride();
  const std::size_t from = inputs.outerStride();
  const std::size_t to = next.outerStride();
  const double* const x = states.data();
  const double* const u = inputs.data();
  double* const y = next.data();
  for_vectors(states.cols(), [&](std::size_t i, auto load_at, auto store_at, std::size_t) HWY_ATTR {
    const Vector heading = load_at(x + Bicycle::kHeading * in + i);
    const Vector speed = load_at(x + Bicycle::kLongitudinalSpeed * in + i);
    const Vector lateral = load_at(x + Bicycle::kLateralSpeed * in + i);
    const Vector yaw_rate = load_at(x + Bicycle::kYawRate * in + i);
    const Vector acceleration = load_at(u + Bicycle::kAcceleration * from + i);
    const Vector steering = load_at(u + Bicycle::kSteeringAngle * from + i);
    const SineCosine direction = sine_cosine(heading);
    const Vector by_force = constant(1.0) / (k.mass * speed + k.axle_sum);
    const Vector by_moment = constant(1.0) / (k.inertia * speed + k.moment_sum);
    const Vector slip = lateral - k.period * (speed * yaw_rate) + k.lateral_kick * steering;
    const Vector turn = yaw_rate + k.yaw_kick * steering;
    store_at(load_at(x + Bicycle::kX * in + i) +
                 k.period * (speed * direction.cosine - lateral * direction.sine),
             y + Bicycle::kX * to + i);
    store_at(load_at(x + Bicycle::kY * in + i) +
                 k.period * (lateral * direction.cosine + speed * direction.sine),
             y + Bicycle::kY * to + i);
    store_at(heading + k.period * yaw_rate, y + Bicycle::kHeading * to + i);
    store_at(speed + k.period * acceleration, y + Bicycle::kLongitudinalSpeed * to + i);
    store_at((constant(1.0) - k.axle_sum * by_force) * slip + k.coupling * yaw_rate * by_force,
             y + Bicycle::kLateralSpeed * to + i);
    store_at((constant(1.0) - k.moment_sum * by_moment) * turn + k.coupling * lateral * by_moment,
             y + Bicycle::kYawRate * to + i);
  });
}

/// In the notation of Bicycle::step: A, B the sums, C the coupling, F = 1/(mv + A), G = 1/(Iv + B),
/// p and q the brackets that (1 − AF) and (1 − BG) multiply; ∂F/∂v = −mF², ∂G/∂v = −IG².
void bicycle_pullback(const Bicycle& car, const Dynamics::BatchView& states,
                      const Dynamics::BatchView& inputs, const Dynamics::BatchView& next_adjoint,
                      Dynamics::BatchOut& state_adjoint, Dynamics::BatchOut& input_adjoint) {
  const BicycleVectors k(car);
  const std::size_t in = states.outerStride();
  const std::size_t out = next_adjoint.outerStride();
  const std::size_t to = state_adjoint.outerStride();
  const double* const x = states.data();
  const double* const steer =
      inputs.data() + Bicycle::kSteeringAngle * static_cast<std::size_t>(inputs.outerStride());
  const double* const g = next_adjoint.data();
  double* const a = state_adjoint.data();
  double* const b = input_adjoint.data();
  const std::size_t to_input = input_adjoint.outerStride();
  for_vectors(states.cols(), [&](std::size_t i, auto load_at, auto store_at, std::size_t) HWY_ATTR {
    const Vector speed = load_at(x + Bicycle::kLongitudinalSpeed * in + i);
    const Vector lateral = load_at(x + Bicycle::kLateralSpeed * in + i);
    const Vector yaw_rate = load_at(x + Bicycle::kYawRate * in + i);
    const Vector steering = load_at(steer + i);
    const SineCosine direction = sine_cosine(load_at(x + Bicycle::kHeading * in + i));
    const Vector of_x = load_at(g + Bicycle::kX * out + i);
    const Vector of_y = load_at(g + Bicycle::kY * out + i);
    const Vector of_heading = load_at(g + Bicycle::kHeading * out + i);
    const Vector of_speed = load_at(g + Bicycle::kLongitudinalSpeed * out + i);
    const Vector of_lateral = load_at(g + Bicycle::kLateralSpeed * out + i);
    const Vector of_yaw_rate = load_at(g + Bicycle::kYawRate * out + i);

    const Vector force = constant(1.0) / (k.mass * speed + k.axle_sum);
    const Vector moment = constant(1.0) / (k.inertia * speed + k.moment_sum);
    const Vector slip = lateral - k.period * (speed * yaw_rate) + k.lateral_kick * steering;
    const Vector turn = yaw_rate + k.yaw_kick * steering;
    const Vector through_slip = of_lateral * (constant(1.0) - k.axle_sum * force);
    const Vector through_turn = of_yaw_rate * (constant(1.0) - k.moment_sum * moment);
    // The components of the position's adjoint along the car and to its left.
    const Vector along = of_x * direction.cosine + of_y * direction.sine;
    const Vector across = of_y * direction.cosine - of_x * direction.sine;
    const Vector force_slope = k.mass * force * force * (k.axle_sum * slip - k.coupling * yaw_rate);
    const Vector moment_slope =
        k.inertia * moment * moment * (k.moment_sum * turn - k.coupling * lateral);
    store_at(of_x, a + Bicycle::kX * to + i);
    store_at(of_y, a + Bicycle::kY * to + i);
    store_at(of_heading + k.period * (speed * across - lateral * along),
             a + Bicycle::kHeading * to + i);
    store_at(of_speed + k.period * along - k.period * yaw_rate * through_slip +
                 of_lateral * force_slope + of_yaw_rate * moment_slope,
             a + Bicycle::kLongitudinalSpeed * to + i);
    store_at(k.period * across + through_slip + k.coupling * of_yaw_rate * moment,
             a + Bicycle::kLateralSpeed * to + i);
    store_at(k.period * of_heading - k.period * speed * through_slip +
                 k.coupling * of_lateral * force + through_turn,
             a + Bicycle::kYawRate * to + i);
    store_at(k.period * of_speed, b + Bicycle::kAcceleration * to_input + i);
    store_at(k.lateral_kick * through_slip + k.yaw_kick * through_turn,
             b + Bicycle::kSteeringAngle * to_input + i);
  });
}

}  // namespace HWY_NAMESPACE
}  // namespace qsmpc::models
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace qsmpc::models {

HWY_EXPORT(bicycle_step);
HWY_EXPORT(bicycle_pullback);

void step_bicycle(const Bicycle& car, const Dynamics::BatchView& states,
                  const Dynamics::BatchView& inputs, Dynamics::BatchOut next) {
  HWY_DYNAMIC_DISPATCH(bicycle_step)(car, states, inputs, next);
}

void pullback_bicycle(const Bicycle& car, const Dynamics::BatchView& states,
                      const Dynamics::BatchView& inputs, const Dynamics::BatchView& next_adjoint,
                      Dynamics::BatchOut state_adjoint, Dynamics::BatchOut input_adjoint) {
  HWY_DYNAMIC_DISPATCH(bicycle_pullback)
  (car, states, inputs, next_adjoint, state_adjoint, input_adjoint);
}

}  // namespace qsmpc::models
#endif
