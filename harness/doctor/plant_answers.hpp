// A plant's responses to held inputs, next to those of the planner's model.
//
// Each drive begins at the scenario's mean initial state, settled, and is undisturbed. The first
// one holds the neutral input and shows how the vehicle moves by itself; then each input is held a
// tenth of its half-range to either side, and half of the difference is the response to it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "harness/scenario/scenario.hpp"

namespace qsmpc::harness {

/// The response of one state, in its unit.
struct StateAnswer {
  Eigen::VectorXd model;  ///< change after 1, 2, … periods
  Eigen::VectorXd plant;
  /// Ratio of the plant's response to the model's, fitted together with a delay by least squares;
  /// not a number unless the model's exceeds a hundredth of the state's largest change.
  double ratio = 0.0;
  double delay = 0.0;  ///< s by which the plant's response is later; 0 where the ratio is unknown
  /// Largest difference in the second half of the drive, per period and extrapolated to the full
  /// input: measures what keeps growing, rather than the first periods.
  double discrepancy = 0.0;
};

/// The response to a held input, or to none.
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
  double tilt_at_start = 0.0;          ///< rad, see Plant::tilt; at the start of the drives
  double tilt = 0.0;                   ///< rad, the largest at the end of any drive
  std::optional<std::string> fault{};  ///< the plant's fault; the drives are then incomplete
};

/// Drives the plant of `scenario` without disturbances, variation and solid obstacles. Throws
/// InputError where the plant cannot be made.
[[nodiscard]] PlantAnswers plant_answers(const Scenario& scenario);

}  // namespace qsmpc::harness
