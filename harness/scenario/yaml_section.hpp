// Reads a tree of keys into values and notes all problems instead of stopping at the first: each
// reader returns the value, or the fallback and a noted problem.
//
//   Problems problems("a.yaml");
//   Section root(tree, problems);
//   Section limit = root.section("limit");
//   int steps = limit.whole("steps", 200, {1, 1000});
//   limit.refuse_unread();
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "harness/errors.hpp"
#include "harness/scenario/yaml_tree.hpp"

namespace qsmpc::harness {

/// The problems noted so far, in the order in which they were found.
class Problems {
 public:
  /// `file`: its name in problems; problems with values from the command line name "--set" instead.
  explicit Problems(std::string file) : file_(std::move(file)) {}

  /// Notes a problem with the value `node` of `key`.
  void add(const YamlNode& node, std::string key, std::string found, std::string expected);
  /// Notes a problem of another file.
  void add(InputError::Where where);

  [[nodiscard]] bool empty() const { return list_.empty(); }
  [[nodiscard]] std::size_t size() const { return list_.size(); }
  /// The problems of the command line first, then by line.
  [[nodiscard]] std::vector<InputError::Where> sorted() const;

 private:
  std::string file_;
  std::vector<InputError::Where> list_;
};

/// A range of allowed numbers.
struct NumberRange {
  double least = -std::numeric_limits<double>::infinity();
  double most = std::numeric_limits<double>::infinity();
  bool above_least = false;  ///< whether `least` itself is refused
};

inline constexpr NumberRange kNotNegative{.least = 0.0};
inline constexpr NumberRange kPositive{.least = 0.0, .above_least = true};

inline constexpr std::size_t kLongestName = 100;   ///< bytes; for titles and parts of file names
inline constexpr std::size_t kLongestPath = 1024;  ///< bytes

/// A range of allowed whole numbers.
struct WholeRange {
  int least = 0;
  int most = std::numeric_limits<int>::max();
};

/// A pair [lower, upper] with lower < upper.
struct NumberInterval {
  double lower = -std::numeric_limits<double>::infinity();
  double upper = std::numeric_limits<double>::infinity();
};

/// One mapping of the tree and its path. A section that is absent, or is not a mapping, is empty.
/// Refers to the tree and the problems, which must outlive it.
class Section {
 public:
  Section(const YamlNode& root, Problems& problems);

  /// The mapping under `key`; a value of another type is noted as a problem.
  [[nodiscard]] Section section(const std::string& key);
  /// Item `index` of the list that `key` holds, as a mapping.
  [[nodiscard]] Section item(const std::string& key, std::size_t index);
  /// The number of items in the list under `key`; 0 without a list.
  [[nodiscard]] std::size_t list_size(const std::string& key);

  [[nodiscard]] bool has(const std::string& key) const { return get(key) != nullptr; }
  /// Whether the value of `key` came from the command line: paths may then also be relative to the
  /// working folder.
  [[nodiscard]] bool is_override(const std::string& key) const {
    return has(key) && get(key)->from_override;
  }
  /// Whether `key` holds a scalar.
  [[nodiscard]] bool holds_text(const std::string& key);
  /// Whether the section is in the tree, as a mapping.
  [[nodiscard]] bool present() const { return node_ != nullptr; }
  [[nodiscard]] std::vector<std::string> keys() const;

  /// Notes that `key` is missing, if it is. `expected`: what it should hold.
  void require(const std::string& key, const std::string& expected);

  [[nodiscard]] double number(const std::string& key, double fallback, NumberRange range = {});
  [[nodiscard]] int whole(const std::string& key, int fallback, WholeRange range);
  [[nodiscard]] std::uint64_t seed(const std::string& key, std::uint64_t fallback);
  [[nodiscard]] bool flag(const std::string& key, bool fallback);
  /// A scalar, verbatim, of at most `longest` bytes and without control characters.
  [[nodiscard]] std::string text(const std::string& key, const std::string& fallback,
                                 std::size_t longest);
  /// A list of scalars, each as for `text`; empty without a list.
  [[nodiscard]] std::vector<std::string> texts(const std::string& key, std::size_t longest);
  /// A scalar that is one of `known`.
  [[nodiscard]] std::string name(const std::string& key, const std::string& fallback,
                                 const std::vector<std::string>& known);
  /// `size` finite numbers.
  [[nodiscard]] std::optional<Eigen::VectorXd> vector(const std::string& key, Eigen::Index size);
  /// Finite numbers, as a list of rows. A flat list of numbers is a diagonal when rows == cols, and
  /// otherwise the only row when rows == 1.
  [[nodiscard]] std::optional<Eigen::MatrixXd> matrix(const std::string& key, Eigen::Index rows,
                                                      Eigen::Index cols);
  /// [lower, upper], lower < upper; ±infinity is allowed unless `finite`.
  [[nodiscard]] std::optional<NumberInterval> interval(const std::string& key, bool finite);

  /// The raw node under `key`; nullptr without one.
  [[nodiscard]] const YamlNode* tree(const std::string& key) { return take(key); }

  /// Notes a problem with the value of `key` (or with this section, without a value); `found`
  /// defaults to a description of the value.
  void note(const std::string& key, const std::string& expected, std::string found = "");

  /// The same for item `index` of the list under `key`, or for the list itself where it is shorter.
  void note_item(const std::string& key, std::size_t index, const std::string& expected,
                 std::string found = "");

  /// Notes a problem with this section as a whole.
  void note_here(const std::string& expected, std::string found);

  /// Notes every key that no reader above has asked for, suggesting the nearest key that one has.
  void refuse_unread();

  /// The dotted path of `key`.
  [[nodiscard]] std::string path_of(const std::string& key) const;

 private:
  Section(const YamlNode* node, const YamlNode& origin, std::string path, Problems& problems);

  [[nodiscard]] const YamlNode* get(const std::string& key) const;
  [[nodiscard]] const YamlNode* take(const std::string& key);
  [[nodiscard]] const YamlNode* take_scalar(const std::string& key, const std::string& expected);
  [[nodiscard]] std::optional<Eigen::VectorXd> numbers(const YamlNode& list,
                                                       const std::string& path, Eigen::Index size,
                                                       const std::string& expected);

  const YamlNode* node_;    // nullptr where the section is absent
  const YamlNode* origin_;  // the nearest existing node, for line numbers
  std::string path_;
  Problems* problems_;
  std::vector<std::string> asked_;
};

/// The number that a scalar represents in YAML (.inf included), or nothing.
[[nodiscard]] std::optional<double> parse_number(const YamlNode& node);

}  // namespace qsmpc::harness
