#include "harness/scenario/yaml_text.hpp"

#include <cmath>

#include <fmt/format.h>

namespace qsmpc {

std::string yaml_number(double value) {
  if (std::isinf(value)) return value > 0 ? ".inf" : "-.inf";
  return fmt::format("{}", value);
}

std::string quoted_yaml(std::string_view text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    out += c;
  }
  return out + '"';
}

std::string yaml_list(const Eigen::VectorXd& values) {
  std::string out = "[";
  for (Eigen::Index i = 0; i < values.size(); ++i) {
    out += (i == 0 ? "" : ", ") + yaml_number(values[i]);
  }
  return out + "]";
}

std::string yaml_rows(const Eigen::MatrixXd& matrix) {
  std::string out = "[";
  for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
    out += (i == 0 ? "" : ", ") + yaml_list(matrix.row(i).transpose());
  }
  return out + "]";
}

std::string yaml_square(const Eigen::MatrixXd& matrix) {
  for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
    for (Eigen::Index j = 0; j < matrix.cols(); ++j) {
      if (i != j && (matrix(i, j) != 0.0 || std::signbit(matrix(i, j)))) return yaml_rows(matrix);
    }
  }
  return yaml_list(matrix.diagonal());
}

}  // namespace qsmpc
