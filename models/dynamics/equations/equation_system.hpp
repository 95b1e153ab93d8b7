// A system defined by formulas instead of code.
//
//   EquationSystem car{.states = {{"x", "m"}, {"heading", "rad", true}},
//                      .inputs = {{"yaw_rate", "rad/s"}},
//                      .input_lower = …, .input_upper = …,
//                      .parameters = {{"speed", 1.5, "m/s"}},
//                      .equations = {{"x", "x + time_step * speed * cos(heading)"},
//                                    {"heading", "heading + time_step * yaw_rate"}}};
//   const auto dynamics = make_equation_dynamics(car, /*time_step=*/0.1);
//
// Its derivatives, their enclosures and steps of whole batches are derived from the formulas.
#pragma once

#include <cstddef>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "models/dynamics/dynamics.hpp"

namespace qsmpc::models {

/// The name of the control period in formulas, besides those of states, inputs, parameters and
/// definitions.
inline constexpr const char* kTimeStepName = "time_step";

/// The largest number of integrator steps in a control period.
inline constexpr int kMostSubsteps = 100;

struct EquationSystem {
  struct Parameter {
    std::string name;
    double value = 0.0;
    std::string unit{};
  };
  struct Formula {
    std::string name;  ///< of its state, or of what it defines
    std::string text;
  };
  enum class Time {
    kDiscrete,  ///< formulas give the states after a control period
    kEuler,     ///< formulas give their derivatives, integrated by Euler's method
    kRungeKutta,
  };

  std::string name = "equations";
  std::string summary{};
  std::vector<Coordinate> states;
  std::vector<Coordinate> inputs;
  Eigen::VectorXd input_lower;  ///< input_dim
  Eigen::VectorXd input_upper;
  std::vector<Parameter> parameters{};
  std::vector<Formula> definitions{};  ///< auxiliary formulas, which may use each other
  std::vector<Formula> equations{};    ///< one for each state, in any order
  Time time = Time::kDiscrete;
  int substeps = 1;     ///< of the integrator, 1 to kMostSubsteps
  int position_x = -1;  ///< indices of states, as in SystemDescription
  int position_y = -1;
  int heading = -1;
  /// Whether derivatives are known; without them no certificate is given.
  bool differentiable = true;
};

[[nodiscard]] SystemDescription description_of(const EquationSystem& system);

/// An error in a system of equations.
class EquationError : public std::invalid_argument {
 public:
  struct Where {
    std::string section;  ///< "states", "inputs", "parameters", "define" or "equations"
    std::string name{};   ///< the entry in the section
    std::string found{};
    std::string expected{};
    /// The name that is not among `known`, if that is the error.
    std::string unknown{};
    std::vector<std::string> known{};
  };
  explicit EquationError(Where where);
  [[nodiscard]] const Where& where() const { return where_; }

 private:
  Where where_;
};

/// Throws EquationError if there are no states, no inputs, or too many of them.
void check_sizes(const EquationSystem& system);

/// Throws EquationError if names collide, a state has no equation or an equation no state, a
/// formula is invalid or uses an unknown name, or definitions are circular; and
/// std::invalid_argument unless time_step (s) is finite and above 0. No global Lipschitz constant
/// is known if a derivative is not bounded everywhere.
[[nodiscard]] std::unique_ptr<const Dynamics> make_equation_dynamics(const EquationSystem& system,
                                                                     double time_step);

}  // namespace qsmpc::models
