// Values as YAML that reads back as the same values.
#pragma once

#include <string>
#include <string_view>

#include <Eigen/Core>

#include "harness/scenario/yaml_tree.hpp"

namespace qsmpc::harness {

/// The shortest text that reads back as the same double.
[[nodiscard]] std::string yaml_number(double value);

/// Always quoted, so that no text can be read as a number, a null or surrounding syntax. Control
/// characters are escaped.
[[nodiscard]] std::string quoted_yaml(std::string_view text);

/// [a, b, …].
[[nodiscard]] std::string yaml_list(const Eigen::VectorXd& values);

/// [[a, b], [c, d]], row by row.
[[nodiscard]] std::string yaml_rows(const Eigen::MatrixXd& matrix);

/// A square matrix as its diagonal where that is lossless, including the signs of zeros; else by
/// rows.
[[nodiscard]] std::string yaml_square(const Eigen::MatrixXd& matrix);

/// A tree in flow style on one line, e.g. {x: [2, 4], name: "a b"}. It reads back as the same tree:
/// quoted scalars stay quoted, and plain ones other than numbers and names become quoted (readers
/// do not distinguish the two).
[[nodiscard]] std::string yaml_flow(const YamlNode& node);

}  // namespace qsmpc::harness
