// A unicycle whose speed and yaw rate follow their commands with a lag, as motors do.
#include <cmath>

#include <qsmpc/models/dynamics/own_dynamics.hpp>

struct LagUnicycle {
  enum State { kX, kY, kHeading, kSpeed, kYawRate };
  enum Input { kSpeedCommand, kYawRateCommand };

  static qsmpc::own::System system() {
    return {
        .name = "lag_unicycle",
        .summary = "Unicycle with actuator lag",
        .states = {{"x", "m"},
                   {"y", "m"},
                   {"heading", "rad", true},
                   {"speed", "m/s"},
                   {"yaw_rate", "rad/s"}},
        .inputs = {{"speed_command", "m/s", 0.0, 2.0}, {"yaw_rate_command", "rad/s", -1.0, 1.0}},
        .parameters = {{"speed_lag", "s", 0.3}, {"yaw_lag", "s", 0.15}},
        .position_x = "x",
        .position_y = "y",
        .heading = "heading"};
  }

  explicit LagUnicycle(const qsmpc::own::Setup& setup)
      : time_step(setup.time_step),
        speed_kept(std::exp(-setup.time_step / setup.positive("speed_lag"))),
        yaw_kept(std::exp(-setup.time_step / setup.positive("yaw_lag"))) {}

  template <class Scalar>
  void step(const Scalar* x, const Scalar* u, Scalar* next) const {
    using std::cos;
    using std::sin;
    next[kX] = x[kX] + time_step * x[kSpeed] * cos(x[kHeading]);
    next[kY] = x[kY] + time_step * x[kSpeed] * sin(x[kHeading]);
    next[kHeading] = x[kHeading] + time_step * x[kYawRate];
    next[kSpeed] = u[kSpeedCommand] + speed_kept * (x[kSpeed] - u[kSpeedCommand]);
    next[kYawRate] = u[kYawRateCommand] + yaw_kept * (x[kYawRate] - u[kYawRateCommand]);
  }

  double time_step;   // s
  double speed_kept;  // share of the difference from the command that is left after a period
  double yaw_kept;
};
QSMPC_REGISTER_DYNAMICS(LagUnicycle)
