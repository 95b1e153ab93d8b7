// Inputs along a horizon from a CSV file: one row a stage, one column an input.
//
//   yaw_rate        a first line that names the inputs may be there, in any order;
//   0.3             then one line a stage.
//   -0.1
#pragma once

#include <optional>
#include <string>

#include <Eigen/Core>

#include "controller/prediction/policy.hpp"
#include "models/dynamics/dynamics.hpp"

namespace qsmpc::harness {

/// What the file has to fit to.
struct InputTableFormat {
  std::vector<models::Coordinate> inputs;  ///< one column each
  controller::InputBounds bounds;          ///< every number lies within
  std::optional<int> stages{};  ///< how many rows are read, of which there are at least as many
};

/// The inputs in the file at `path` (input_dim x rows). Throws InputError with file, line, column,
/// what was found and what is expected, on whatever is no such table; a number outside the bounds
/// is refused as well, since certificates hold for inputs that are applied as they are.
[[nodiscard]] Eigen::MatrixXd read_input_table(const std::string& path,
                                               const InputTableFormat& format);

/// As `read_input_table`, from the text itself; `file` is what errors call it.
[[nodiscard]] Eigen::MatrixXd parse_input_table(const std::string& text, const std::string& file,
                                                const InputTableFormat& format);

}  // namespace qsmpc::harness
