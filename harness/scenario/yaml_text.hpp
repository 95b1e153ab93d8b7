// Values as YAML that reads back as the same values.
#pragma once

#include <string>
#include <string_view>

#include <Eigen/Core>

namespace qsmpc {

/// The shortest text that reads back as the same double.
[[nodiscard]] std::string yaml_number(double value);

/// Always quoted: no text can then be taken for a number, a null or the syntax around it.
/// text: without control characters.
[[nodiscard]] std::string quoted_yaml(std::string_view text);

/// [a, b, …].
[[nodiscard]] std::string yaml_list(const Eigen::VectorXd& values);

/// [[a, b], [c, d]], row by row.
[[nodiscard]] std::string yaml_rows(const Eigen::MatrixXd& matrix);

/// A square matrix as its diagonal where that loses nothing, not even the sign of a zero; else by
/// rows.
[[nodiscard]] std::string yaml_square(const Eigen::MatrixXd& matrix);

}  // namespace qsmpc
