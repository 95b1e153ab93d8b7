// What a plant answers to inputs that are held, next to what the planner's model answers.
//
// A drive begins at the scenario's mean initial state, settled, and is without disturbance. The
// first holds the neutral input and shows what the vehicle does by itself; then each input is held
// a tenth of its half-range to either side, and half of the difference is its answer.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "harness/scenario/scenario.hpp"

namespace qsmpc::harness {

/// Of one state, in its unit.
struct StateAnswer {
  Eigen::VectorXd model;  ///< change after 1, 2, … periods
  Eigen::VectorXd plant;
  /// The plant's answer over the model's, fitted together with a delay by least squares; not a
  /// number where the model's is not above a hundredth of the state's largest change.
  double ratio = 0.0;
  double delay = 0.0;  ///< s by which the plant's is later; 0 where the ratio is unknown
  /// Largest difference in the second half of the drive, by period and extrapolated to the full
  /// input: what goes on growing, not how the first periods begin.
  double discrepancy = 0.0;
};

/// To an input that is held, or to none.
struct InputAnswer {
  int input = -1;          ///< -1: none
  double amplitude = 0.0;  ///< to either side of the neutral input, in the input's unit
  std::vector<StateAnswer> states;
};

struct PlantAnswers {
  int periods = 0;
  double period = 0.0;  ///< s
  Eigen::VectorXd start;
  Eigen::VectorXd scale;               ///< the model's largest change of each state in these drives
  std::vector<InputAnswer> inputs;     ///< none first, then each input
  double tilt_at_start = 0.0;          ///< rad, see Plant::tilt; where the drives begin
  double tilt = 0.0;                   ///< rad, the largest at the end of a drive
  std::optional<std::string> fault{};  ///< how the plant broke; the drives are then not complete
};

/// Drives the plant of `scenario`, without its disturbances, its variation and solid obstacles.
/// Throws InputError where the plant cannot be made.
[[nodiscard]] PlantAnswers plant_answers(const Scenario& scenario);

}  // namespace qsmpc::harness
