#include "harness/scenario/yaml_text.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstddef>

#include <fmt/format.h>

#include "harness/text/utf8.hpp"

namespace qsmpc::harness {
namespace {

// The limit for a YAML key without a "?" before it.
constexpr std::size_t kLongestPlainKey = 1000;  // bytes; the parser's limit is 1024 characters

bool is_word(std::string_view text) {
  const bool only_word_characters = std::ranges::all_of(text, [](unsigned char c) {
    return std::isalnum(c) != 0 || c == '_' || c == '.' || c == '-' || c == '+' || c == '/';
  });
  const bool is_null = text == "null" || text == "Null" || text == "NULL";
  const bool is_mark = text.starts_with("---") || text.starts_with("...") || text == "-";
  return !text.empty() && only_word_characters && !is_null && !is_mark;
}

std::string flow_key(const std::string& key) {
  const std::string text = is_word(key) ? key : quoted_yaml(key);
  return text.size() > kLongestPlainKey ? "? " + text : text;
}

}  // namespace

std::string yaml_number(double value) {
  if (std::isinf(value)) return value > 0 ? ".inf" : "-.inf";
  return fmt::format("{}", value);
}

std::string quoted_yaml(std::string_view text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '\n') {
      out += "\\n";
    } else if (is_control_character(c)) {
      out += fmt::format("\\x{:02X}", static_cast<unsigned char>(c));
    } else {
      if (c == '"' || c == '\\') out += '\\';
      out += c;
    }
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

std::string yaml_flow(const YamlNode& node) {
  if (node.kind == YamlNode::Kind::kNull) return "null";
  if (node.kind == YamlNode::Kind::kText) {
    return node.quoted || !is_word(node.text) ? quoted_yaml(node.text) : node.text;
  }
  const bool is_map = node.kind == YamlNode::Kind::kMap;
  std::string out = is_map ? "{" : "[";
  for (std::size_t i = 0; i < node.items.size(); ++i) {
    if (i > 0) out += ", ";
    if (is_map) out += flow_key(node.keys[i]) + ": ";
    out += yaml_flow(node.items[i]);
  }
  return out + (is_map ? "}" : "]");
}

}  // namespace qsmpc::harness
