// Rows of numbers in a scenario: [[0, 0], [5, 0], [10, 3]].
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "harness/scenario/yaml_section.hpp"

namespace qsmpc::harness {

/// What rows may be.
struct RowForm {
  std::vector<std::size_t> widths;  ///< how many numbers a row may have
  std::string words;                ///< what that means: "[x, y]"
  std::string name = "places";      ///< what the rows are, for errors about their number
  std::size_t least = 1;            ///< how many rows
  std::size_t most = 1000;
  bool alike = true;  ///< whether all rows have as many numbers as the first
};

/// The rows under `key`, which is there, of finite numbers; nothing, and a problem noted with the
/// row, where they are something else.
[[nodiscard]] std::optional<std::vector<Eigen::VectorXd>> read_rows(Section& section,
                                                                    const std::string& key,
                                                                    const RowForm& form);

/// Rows that are alike as a matrix, n x width; empty without a row.
[[nodiscard]] Eigen::MatrixXd matrix_of(const std::vector<Eigen::VectorXd>& rows);

}  // namespace qsmpc::harness
