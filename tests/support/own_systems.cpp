#include "tests/support/own_systems.hpp"

#include <vector>

// The source as users compile it, but included in this program.
#include "examples/lag_unicycle/lag_unicycle.cpp"
#include "examples/planar_quadrotor/planar_quadrotor.cpp"

#include "models/constants.hpp"
#include "models/dynamics/own_system.hpp"
#include "models/dynamics/templated_dynamics.hpp"

namespace qsmpc::testing {

using models::EquationSystem;

EquationSystem lag_unicycle_equations() {
  return {
      .name = "lag_unicycle_by_equations",
      .summary = "Unicycle with actuator lag",
      .states = {{"x", "m"},
                 {"y", "m"},
                 {"heading", "rad", true},
                 {"speed", "m/s"},
                 {"yaw_rate", "rad/s"}},
      .inputs = {{"speed_command", "m/s"}, {"yaw_rate_command", "rad/s"}},
      .input_lower = Eigen::Vector2d(0.0, -1.0),
      .input_upper = Eigen::Vector2d(2.0, 1.0),
      .parameters = {{"speed_lag", 0.3, "s"}, {"yaw_lag", 0.15, "s"}},
      .definitions = {{"speed_kept", "exp(-time_step / speed_lag)"},
                      {"yaw_kept", "exp(-time_step / yaw_lag)"}},
      .equations = {{"x", "x + time_step * speed * cos(heading)"},
                    {"y", "y + time_step * speed * sin(heading)"},
                    {"heading", "heading + time_step * yaw_rate"},
                    {"speed", "speed_command + speed_kept * (speed - speed_command)"},
                    {"yaw_rate", "yaw_rate_command + yaw_kept * (yaw_rate - yaw_rate_command)"}},
      .position_x = 0,
      .position_y = 1,
      .heading = 2};
}

EquationSystem planar_quadrotor_equations() {
  return {.name = "planar_quadrotor_by_equations",
          .summary = "Quadrotor in a vertical plane",
          .states = {{"x", "m"},
                     {"z", "m"},
                     {"pitch", "rad", true},
                     {"velocity_x", "m/s"},
                     {"velocity_z", "m/s"},
                     {"pitch_rate", "rad/s"}},
          .inputs = {{"left", "N"}, {"right", "N"}},
          .input_lower = Eigen::Vector2d(0.0, 0.0),
          .input_upper = Eigen::Vector2d(8.0, 8.0),
          .parameters = {{"mass", 0.8, "kg"},
                         {"inertia", 0.01, "kg m^2"},
                         {"arm", 0.2, "m"},
                         {"gravity", 9.81, "m/s^2"}},
          .definitions = {{"lift", "(left + right) / mass"}},
          .equations = {{"x", "velocity_x"},
                        {"z", "velocity_z"},
                        {"pitch", "pitch_rate"},
                        {"velocity_x", "lift * sin(pitch)"},
                        {"velocity_z", "lift * cos(pitch) - gravity"},
                        {"pitch_rate", "(arm / inertia) * (left - right)"}},
          .time = EquationSystem::Time::kRungeKutta,
          .position_x = 0,
          .position_y = 1};
}

EquationSystem every_function_equations() {
  return {.name = "every_function",
          .summary = "Every smooth function that formulas may call",
          .states = {{"a", "1"}, {"b", "1"}},
          .inputs = {{"u", "1"}},
          .input_lower = Eigen::VectorXd::Constant(1, -1.0),
          .input_upper = Eigen::VectorXd::Constant(1, 1.0),
          .definitions = {{"inside", "0.8 * sin(a + u)"},
                          {"positive", "1.5 + cos(b)"},
                          {"root", "sqrt(positive) + log(positive) + positive^1.3 + positive^-2"},
                          {"arcs", "asin(inside) + acos(0.5 * inside) + atan(a - b)"},
                          {"growth", "exp(inside) + sinh(inside) + cosh(inside) + tanh(a * u)"},
                          {"turn", "atan2(inside, positive) + tan(inside)"},
                          {"powers", "(0.2 * a)^3 + inside^2 + pow(positive, inside)"}},
          .equations = {{"a", "root + arcs / positive + u"}, {"b", "growth + turn + powers"}}};
}

const std::vector<std::string>& own_system_names() {
  static const std::vector<std::string> names{"lag_unicycle", "lag_unicycle_by_equations",
                                              "planar_quadrotor", "planar_quadrotor_by_equations",
                                              "every_function"};
  return names;
}

std::unique_ptr<const models::Dynamics> make_any_dynamics(const std::string& name,
                                                          double time_step) {
  for (const EquationSystem& system :
       {lag_unicycle_equations(), planar_quadrotor_equations(), every_function_equations()}) {
    if (system.name == name) return models::make_equation_dynamics(system, time_step);
  }
  const qsmpc_dynamics_table& table = *qsmpc_dynamics();
  for (std::uint32_t i = 0; i < table.system_count; ++i) {
    const qsmpc_system& system = *table.systems[i];
    if (name != system.name) continue;
    return models::make_own_dynamics(system, models::own_system_of(system), time_step, nullptr);
  }
  return models::make_dynamics(name, {}, time_step);
}

namespace {

/// A user's system as a built-in one.
template <class Model, int kStates, int kInputs>
struct BuiltIn : Model {
  static constexpr int kStateDim = kStates;
  static constexpr int kInputDim = kInputs;

  explicit BuiltIn(double period) : Model(own::Setup(period, parameters(), values().data())) {}

  [[nodiscard]] models::SystemDescription description() const {
    return make_any_dynamics(Model::system().name, 1.0)->description();
  }
  [[nodiscard]] double lipschitz(const Eigen::Ref<const Eigen::MatrixXd>& /*gain*/) const {
    return kInfinity;
  }

 private:
  static const std::vector<own::Parameter>& parameters() {
    static const std::vector<own::Parameter> all = Model::system().parameters;
    return all;
  }
  static const std::vector<double>& values() {
    static const std::vector<double> all = [] {
      std::vector<double> numbers;
      for (const own::Parameter& parameter : parameters()) numbers.push_back(parameter.value);
      return numbers;
    }();
    return all;
  }
};

template <class Model, int kStates, int kInputs>
std::unique_ptr<const models::Dynamics> built_in(double time_step) {
  return std::make_unique<models::TemplatedDynamics<BuiltIn<Model, kStates, kInputs>>>(
      BuiltIn<Model, kStates, kInputs>(time_step));
}

}  // namespace

std::unique_ptr<const models::Dynamics> make_built_in(const std::string& name, double time_step) {
  return name == "lag_unicycle" ? built_in<LagUnicycle, 5, 2>(time_step)
                                : built_in<PlanarQuadrotor, 6, 2>(time_step);
}

}  // namespace qsmpc::testing
