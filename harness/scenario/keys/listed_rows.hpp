// Rows of numbers in a scenario: [[0, 0], [5, 0], [10, 3]].
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "harness/scenario/yaml_section.hpp"

namespace qsmpc::harness {

/// The allowed form of rows.
struct RowForm {
  std::vector<std::size_t> widths;  ///< the allowed numbers of entries per row
  std::string words;                ///< the same in words: "[x, y]"
  std::string name = "places";      ///< the plural noun for the rows in errors about their number
  std::size_t least = 1;            ///< the minimum number of rows
  std::size_t most = 1000;
  bool alike = true;  ///< whether all rows must have the same length as the first
};

/// The rows of finite numbers under `key`, which must be present; nothing, and a noted problem with
/// its row, where they are invalid.
[[nodiscard]] std::optional<std::vector<Eigen::VectorXd>> read_rows(Section& section,
                                                                    const std::string& key,
                                                                    const RowForm& form);

/// Rows of equal length as a matrix, n x width; empty without rows.
[[nodiscard]] Eigen::MatrixXd matrix_of(const std::vector<Eigen::VectorXd>& rows);

}  // namespace qsmpc::harness
