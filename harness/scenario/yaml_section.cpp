#include "harness/scenario/yaml_section.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "harness/scenario/known_names.hpp"
#include "harness/scenario/overrides.hpp"
#include "harness/text/number_parse.hpp"
#include "harness/text/text_encoding.hpp"

namespace qsmpc::harness {
namespace {

constexpr std::size_t kMostProblems = 100;  // more do not help, and cost time on a hostile file

std::string describe(const NumberRange& range) {
  if (std::isinf(range.least) && std::isinf(range.most)) return "a finite number";
  const std::string lower = fmt::format("{} {}", range.above_least ? ">" : ">=", range.least);
  if (std::isinf(range.most)) return "a number " + lower;
  if (std::isinf(range.least)) return fmt::format("a number <= {}", range.most);
  return fmt::format("a number {} and <= {}", lower, range.most);
}

bool is_within(double value, const NumberRange& range) {
  const bool enough = range.above_least ? value > range.least : value >= range.least;
  return std::isfinite(value) && enough && value <= range.most;
}

template <class Integer>
std::optional<Integer> integer_in(const YamlNode& node) {
  if (node.kind != YamlNode::Kind::kText || node.quoted) return std::nullopt;
  return parse_integer<Integer>(node.text);
}

}  // namespace

std::optional<double> parse_number(const YamlNode& node) {
  if (node.kind != YamlNode::Kind::kText || node.quoted) return std::nullopt;
  std::string_view text = node.text;
  const bool negative = text.starts_with('-');
  if (negative || text.starts_with('+')) text.remove_prefix(1);
  if (text == ".inf" || text == ".Inf" || text == ".INF") {
    const double infinity = std::numeric_limits<double>::infinity();
    return negative ? -infinity : infinity;
  }
  if (text == ".nan" || text == ".NaN" || text == ".NAN") {
    return std::numeric_limits<double>::quiet_NaN();
  }
  return parse_decimal(node.text);
}

void Problems::add(const YamlNode& node, std::string key, std::string found, std::string expected) {
  if (list_.size() >= kMostProblems) return;
  const int line = node.key_line > 0 ? node.key_line : node.line;
  list_.push_back({.file = node.from_override ? kOverrideSource : file_,
                   .line = node.from_override ? 0 : line,
                   .key = std::move(key),
                   .found = std::move(found),
                   .expected = std::move(expected)});
}

void Problems::add(InputError::Where where) {
  if (list_.size() < kMostProblems) list_.push_back(std::move(where));
}

std::vector<InputError::Where> Problems::sorted() const {
  std::vector<InputError::Where> sorted = list_;
  std::stable_sort(sorted.begin(), sorted.end(),
                   [](const auto& a, const auto& b) { return a.line < b.line; });
  return sorted;
}

Section::Section(const YamlNode& root, Problems& problems)
    : Section(root.kind == YamlNode::Kind::kMap ? &root : nullptr, root, "", problems) {
  if (node_ == nullptr) {
    problems.add(root, "", harness::describe(root), "a mapping of keys to values");
  }
}

Section::Section(const YamlNode* node, const YamlNode& origin, std::string path, Problems& problems)
    : node_(node), origin_(&origin), path_(std::move(path)), problems_(&problems) {}

std::string Section::path_of(const std::string& key) const {
  return path_.empty() ? key : path_ + "." + key;
}

const YamlNode* Section::get(const std::string& key) const {
  return node_ == nullptr ? nullptr : node_->find(key);
}

const YamlNode* Section::take(const std::string& key) {
  if (std::find(asked_.begin(), asked_.end(), key) == asked_.end()) asked_.push_back(key);
  return get(key);
}

bool Section::holds_text(const std::string& key) {
  const YamlNode* node = take(key);
  return node != nullptr && node->kind == YamlNode::Kind::kText;
}

std::vector<std::string> Section::keys() const {
  return node_ == nullptr ? std::vector<std::string>{} : node_->keys;
}

Section Section::section(const std::string& key) {
  const YamlNode* node = take(key);
  const bool is_map = node != nullptr && node->kind == YamlNode::Kind::kMap;
  if (node != nullptr && !is_map) note(key, "a mapping of keys to values");
  return {is_map ? node : nullptr, node != nullptr ? *node : *origin_, path_of(key), *problems_};
}

std::size_t Section::list_size(const std::string& key) {
  const YamlNode* node = take(key);
  if (node == nullptr) return 0;
  if (node->kind != YamlNode::Kind::kList) {
    note(key, "a list");
    return 0;
  }
  return node->items.size();
}

Section Section::item(const std::string& key, std::size_t index) {
  const YamlNode& node = take(key)->items.at(index);
  const std::string path = fmt::format("{}.{}", path_of(key), index);
  const bool is_map = node.kind == YamlNode::Kind::kMap;
  if (!is_map) problems_->add(node, path, harness::describe(node), "a mapping of keys to values");
  return {is_map ? &node : nullptr, node, path, *problems_};
}

void Section::require(const std::string& key, const std::string& expected) {
  // A section of the wrong type is already noted; its keys are not reported as missing too.
  const bool noted = node_ == nullptr && origin_->kind != YamlNode::Kind::kMap;
  if (take(key) == nullptr && !noted) problems_->add(*origin_, path_of(key), "nothing", expected);
}

void Section::note(const std::string& key, const std::string& expected, std::string found) {
  const YamlNode* node = get(key);
  if (found.empty()) found = node == nullptr ? "nothing" : harness::describe(*node);
  problems_->add(node == nullptr ? *origin_ : *node, path_of(key), std::move(found), expected);
}

void Section::note_item(const std::string& key, std::size_t index, const std::string& expected,
                        std::string found) {
  const YamlNode& list = *get(key);
  const YamlNode& item = index < list.items.size() ? list.items[index] : list;
  if (found.empty()) found = harness::describe(item);
  problems_->add(item, fmt::format("{}.{}", path_of(key), index), std::move(found), expected);
}

void Section::note_here(const std::string& expected, std::string found) {
  problems_->add(*origin_, path_, std::move(found), expected);
}

const YamlNode* Section::take_scalar(const std::string& key, const std::string& expected) {
  const YamlNode* node = take(key);
  if (node == nullptr || node->kind == YamlNode::Kind::kText) return node;
  note(key, expected);
  return nullptr;
}

double Section::number(const std::string& key, double fallback, NumberRange range) {
  const YamlNode* node = take(key);
  if (node == nullptr) return fallback;
  const std::optional<double> value = parse_number(*node);
  if (value && is_within(*value, range)) return *value;
  note(key, describe(range));
  return fallback;
}

int Section::whole(const std::string& key, int fallback, WholeRange range) {
  const YamlNode* node = take(key);
  if (node == nullptr) return fallback;
  const std::optional<int> value = integer_in<int>(*node);
  if (value && *value >= range.least && *value <= range.most) return *value;
  note(key, fmt::format("a whole number from {} to {}", range.least, range.most));
  return fallback;
}

std::uint64_t Section::seed(const std::string& key, std::uint64_t fallback) {
  const YamlNode* node = take(key);
  if (node == nullptr) return fallback;
  if (const auto value = integer_in<std::uint64_t>(*node)) return *value;
  note(key, "a whole number from 0 to 18446744073709551615");
  return fallback;
}

bool Section::flag(const std::string& key, bool fallback) {
  const YamlNode* node = take(key);
  if (node == nullptr) return fallback;
  const bool plain = node->kind == YamlNode::Kind::kText && !node->quoted;
  const auto is = [&](auto... words) { return plain && ((node->text == words) || ...); };
  if (is("true", "True", "TRUE")) return true;
  if (is("false", "False", "FALSE")) return false;
  note(key, "true or false");
  return fallback;
}

std::string Section::text(const std::string& key, const std::string& fallback,
                          std::size_t longest) {
  const YamlNode* node = take_scalar(key, "text");
  if (node == nullptr) return fallback;
  if (node->text.size() > longest) {
    note(key, fmt::format("text of at most {} bytes", longest),
         fmt::format("{} bytes", node->text.size()));
    return fallback;
  }
  // An escape in a quoted scalar can produce characters that the file itself may not contain. A
  // folded block (">") ends in a line feed that is not part of the text.
  std::string text = node->text.substr(0, node->text.find_last_not_of('\n') + 1);
  const bool is_one_line = text.find_first_of("\n\r\t") == std::string::npos;
  if (!is_one_line || find_text_problem(text)) {
    note(key, "one line of text without control characters");
    return fallback;
  }
  return text;
}

std::vector<std::string> Section::texts(const std::string& key, std::size_t longest) {
  std::vector<std::string> texts;
  const std::size_t size = list_size(key);
  for (std::size_t i = 0; i < size; ++i) {
    const YamlNode& item = get(key)->items[i];
    const bool is_text = item.kind == YamlNode::Kind::kText;
    if (is_text && item.text.size() <= longest && !find_text_problem(item.text)) {
      texts.push_back(item.text);
    } else {
      problems_->add(item, fmt::format("{}.{}", path_of(key), i), harness::describe(item),
                     fmt::format("text of at most {} bytes without control characters", longest));
    }
  }
  return texts;
}

std::string Section::name(const std::string& key, const std::string& fallback,
                          const std::vector<std::string>& known) {
  const YamlNode* node = take(key);
  if (node == nullptr) return fallback;
  const bool is_text = node->kind == YamlNode::Kind::kText;
  if (is_text && std::find(known.begin(), known.end(), node->text) != known.end()) {
    return node->text;
  }
  note(key, expected_names(is_text ? node->text : "", known));
  return fallback;
}

std::optional<Eigen::VectorXd> Section::numbers(const YamlNode& list, const std::string& path,
                                                Eigen::Index size, const std::string& expected) {
  const bool is_list = list.kind == YamlNode::Kind::kList;
  if (!is_list || static_cast<Eigen::Index>(list.items.size()) != size) {
    problems_->add(list, path, harness::describe(list), expected);
    return std::nullopt;
  }
  Eigen::VectorXd values(size);
  bool all_finite = true;
  for (Eigen::Index i = 0; i < size; ++i) {
    const YamlNode& item = list.items[static_cast<std::size_t>(i)];
    const std::optional<double> value = parse_number(item);
    if (!value || !std::isfinite(*value)) {
      problems_->add(item, fmt::format("{}.{}", path, i), harness::describe(item),
                     "a finite number");
      all_finite = false;
      continue;
    }
    values[i] = *value;
  }
  return all_finite ? std::optional(values) : std::nullopt;
}

std::optional<Eigen::VectorXd> Section::vector(const std::string& key, Eigen::Index size) {
  const YamlNode* node = take(key);
  if (node == nullptr) return std::nullopt;
  return numbers(*node, path_of(key), size, fmt::format("a list of {} numbers", size));
}

std::optional<Eigen::MatrixXd> Section::matrix(const std::string& key, Eigen::Index rows,
                                               Eigen::Index cols) {
  const YamlNode* node = take(key);
  if (node == nullptr) return std::nullopt;
  const std::string expected =
      rows == cols ? fmt::format("{0} numbers (a diagonal) or {0} rows of {0}", rows)
      : rows == 1  ? fmt::format("{} numbers (the row)", cols)
                   : fmt::format("{} rows of {} numbers", rows, cols);
  const bool has_rows = node->kind == YamlNode::Kind::kList && !node->items.empty() &&
                        node->items.front().kind == YamlNode::Kind::kList;
  if (!has_rows && (rows == cols || rows == 1)) {
    const auto values = numbers(*node, path_of(key), cols, expected);
    if (!values) return std::nullopt;
    return rows == cols ? Eigen::MatrixXd(values->asDiagonal())
                        : Eigen::MatrixXd(values->transpose());
  }
  if (!has_rows || static_cast<Eigen::Index>(node->items.size()) != rows) {
    note(key, expected);
    return std::nullopt;
  }
  Eigen::MatrixXd matrix(rows, cols);
  bool all_rows = true;
  for (Eigen::Index i = 0; i < rows; ++i) {
    const YamlNode& row = node->items[static_cast<std::size_t>(i)];
    const auto values = numbers(row, fmt::format("{}.{}", path_of(key), i), cols,
                                fmt::format("a row of {} numbers", cols));
    all_rows = all_rows && values.has_value();
    if (values) matrix.row(i) = values->transpose();
  }
  return all_rows ? std::optional(matrix) : std::nullopt;
}

std::optional<NumberInterval> Section::interval(const std::string& key, bool finite) {
  const YamlNode* node = take(key);
  if (node == nullptr) return std::nullopt;
  const std::string expected =
      finite ? "[lower, upper], two finite numbers" : "[lower, upper], two numbers or .inf";
  if (node->kind != YamlNode::Kind::kList || node->items.size() != 2) {
    note(key, expected);
    return std::nullopt;
  }
  std::optional<double> ends[2];
  for (std::size_t i = 0; i < 2; ++i) {
    const YamlNode& item = node->items[i];
    ends[i] = parse_number(item);
    if (!ends[i] || std::isnan(*ends[i]) || (finite && std::isinf(*ends[i]))) {
      problems_->add(item, fmt::format("{}.{}", path_of(key), i), harness::describe(item),
                     expected);
      return std::nullopt;
    }
  }
  if (*ends[0] < *ends[1]) return NumberInterval{*ends[0], *ends[1]};
  note(key, "lower < upper", fmt::format("[{}, {}]", *ends[0], *ends[1]));
  return std::nullopt;
}

void Section::refuse_unread() {
  if (node_ == nullptr) return;
  for (std::size_t i = 0; i < node_->keys.size(); ++i) {
    const std::string& key = node_->keys[i];
    if (std::find(asked_.begin(), asked_.end(), key) != asked_.end()) continue;
    problems_->add(node_->items[i], path_of(key), "an unknown key", expected_names(key, asked_));
    if (problems_->size() >= kMostProblems) return;
  }
}

}  // namespace qsmpc::harness
