// A quadrotor in a vertical plane: two rotors push along its upward axis and turn it by their
// difference.
#include <cmath>

#include <qsmpc/models/dynamics/own_dynamics.hpp>
#include <qsmpc/models/dynamics/runge_kutta.hpp>

struct PlanarQuadrotor {
  enum State { kX, kZ, kPitch, kVelocityX, kVelocityZ, kPitchRate };
  enum Input { kLeft, kRight };

  static qsmpc::own::System system() {
    return {.name = "planar_quadrotor",
            .summary = "Quadrotor in a vertical plane",
            .states = {{"x", "m"},
                       {"z", "m"},
                       {"pitch", "rad", true},
                       {"velocity_x", "m/s"},
                       {"velocity_z", "m/s"},
                       {"pitch_rate", "rad/s"}},
            .inputs = {{"left", "N", 0.0, 8.0}, {"right", "N", 0.0, 8.0}},
            .parameters = {{"mass", "kg", 0.8},
                           {"inertia", "kg m^2", 0.01},
                           {"arm", "m", 0.2},
                           {"gravity", "m/s^2", 9.81}},
            .position_x = "x",
            .position_y = "z"};
  }

  explicit PlanarQuadrotor(const qsmpc::own::Setup& setup)
      : time_step(setup.time_step),
        mass(setup.positive("mass")),
        inertia(setup.positive("inertia")),
        arm(setup.positive("arm")),
        gravity(setup.parameter("gravity")) {}

  template <class Scalar>
  void step(const Scalar* x, const Scalar* u, Scalar* next) const {
    using std::cos;
    using std::sin;
    const auto slopes = [&](const Scalar* at, Scalar* slope) {
      const Scalar lift = (u[kLeft] + u[kRight]) / mass;
      slope[kX] = at[kVelocityX];
      slope[kZ] = at[kVelocityZ];
      slope[kPitch] = at[kPitchRate];
      slope[kVelocityX] = lift * sin(at[kPitch]);
      slope[kVelocityZ] = lift * cos(at[kPitch]) - gravity;
      slope[kPitchRate] = (arm / inertia) * (u[kLeft] - u[kRight]);
    };
    qsmpc::models::runge_kutta_step<6>(slopes, x, time_step, next);
  }

  double time_step;  // s
  double mass;       // kg
  double inertia;    // kg m²
  double arm;        // m
  double gravity;    // m/s²
};
QSMPC_REGISTER_DYNAMICS(PlanarQuadrotor)
