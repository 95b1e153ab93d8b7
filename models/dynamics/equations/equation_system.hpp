// A system that is given by formulas instead of code.
//
//   EquationSystem car{.states = {{"x", "m"}, {"heading", "rad", true}},
//                      .inputs = {{"yaw_rate", "rad/s"}},
//                      .input_lower = …, .input_upper = …,
//                      .parameters = {{"speed", 1.5, "m/s"}},
//                      .equations = {{"x", "x + time_step * speed * cos(heading)"},
//                                    {"heading", "heading + time_step * yaw_rate"}}};
//   const auto dynamics = make_equation_dynamics(car, /*time_step=*/0.1);
//
// Its derivatives, their enclosures, and steps of whole batches are made from the formulas.
#pragma once

#include <cstddef>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "models/dynamics/dynamics.hpp"

namespace qsmpc::models {

/// What an equation is called in formulas besides states, inputs, parameters and definitions.
inline constexpr const char* kTimeStepName = "time_step";

/// Steps of an integrator in a control period.
inline constexpr int kMostSubsteps = 100;

struct EquationSystem {
  struct Parameter {
    std::string name;
    double value = 0.0;
    std::string unit{};
  };
  struct Formula {
    std::string name;  ///< of the state that it is of, or what it defines
    std::string text;
  };
  enum class Time {
    kDiscrete,  ///< formulas are of the states after a control period
    kEuler,     ///< of their derivatives, integrated by Euler's method
    kRungeKutta,
  };

  std::string name = "equations";
  std::string summary{};
  std::vector<Coordinate> states;
  std::vector<Coordinate> inputs;
  Eigen::VectorXd input_lower;  ///< input_dim
  Eigen::VectorXd input_upper;
  std::vector<Parameter> parameters{};
  std::vector<Formula> definitions{};  ///< auxiliary ones, which may use each other
  std::vector<Formula> equations{};    ///< one for each state, in any order
  Time time = Time::kDiscrete;
  int substeps = 1;     ///< of the integrator, 1 to kMostSubsteps
  int position_x = -1;  ///< states, as in SystemDescription
  int position_y = -1;
  int heading = -1;
  /// Whether derivatives are known, without which no certificate is given.
  bool differentiable = true;
};

[[nodiscard]] SystemDescription description_of(const EquationSystem& system);

/// What is wrong with a system of equations.
class EquationError : public std::invalid_argument {
 public:
  struct Where {
    std::string section;  ///< "states", "inputs", "parameters", "define" or "equations"
    std::string name{};   ///< what in it
    std::string found{};
    std::string expected{};
    /// The name that is none of `known`, where it is that.
    std::string unknown{};
    std::vector<std::string> known{};
  };
  explicit EquationError(Where where);
  [[nodiscard]] const Where& where() const { return where_; }

 private:
  Where where_;
};

/// Throws EquationError unless there are states and inputs, and not too many of them.
void check_sizes(const EquationSystem& system);

/// Throws EquationError where names collide, a state has no equation or an equation no state, a
/// formula is none, it uses what is not there, or definitions need each other in a circle; and
/// std::invalid_argument unless time_step (s) is finite and above 0. No global Lipschitz constant
/// is known where a derivative is not bounded everywhere.
[[nodiscard]] std::unique_ptr<const Dynamics> make_equation_dynamics(const EquationSystem& system,
                                                                     double time_step);

}  // namespace qsmpc::models
