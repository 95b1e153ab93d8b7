// Inputs along a horizon from a CSV file: one row per stage, one column per input.
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

/// What the file has to match.
struct InputTableFormat {
  std::vector<models::Coordinate> inputs;  ///< one column each
  controller::InputBounds bounds;          ///< which every number must satisfy
  std::optional<int> stages{};  ///< number of rows to read; the file has at least as many
};

/// The inputs in the file at `path` (input_dim x rows). Throws InputError with file, line, column,
/// what was found and what is expected, if the file is not such a table. Numbers outside the bounds
/// are also refused, since certificates hold for inputs that are applied unchanged.
[[nodiscard]] Eigen::MatrixXd read_input_table(const std::string& path,
                                               const InputTableFormat& format);

/// As `read_input_table`, from the text itself; `file` is its name in errors.
[[nodiscard]] Eigen::MatrixXd parse_input_table(const std::string& text, const std::string& file,
                                                const InputTableFormat& format);

}  // namespace qsmpc::harness
