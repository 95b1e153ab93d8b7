// Reading a tree of keys into values, noting everything that is wrong instead of stopping at the
// first: each reader returns what was there, or the fallback and a noted problem.
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
  /// `file` is what they call the file; values given on the command line are in "--set" instead.
  explicit Problems(std::string file) : file_(std::move(file)) {}

  /// Notes a problem with the value `node` of `key`.
  void add(const YamlNode& node, std::string key, std::string found, std::string expected);
  /// Notes a problem that was found in another file.
  void add(InputError::Where where);

  [[nodiscard]] bool empty() const { return list_.empty(); }
  [[nodiscard]] std::size_t size() const { return list_.size(); }
  /// Those on the command line first, then by line.
  [[nodiscard]] std::vector<InputError::Where> sorted() const;

 private:
  std::string file_;
  std::vector<InputError::Where> list_;
};

/// Which numbers are allowed.
struct NumberRange {
  double least = -std::numeric_limits<double>::infinity();
  double most = std::numeric_limits<double>::infinity();
  bool above_least = false;  ///< whether `least` itself is refused
};

inline constexpr NumberRange kNotNegative{.least = 0.0};
inline constexpr NumberRange kPositive{.least = 0.0, .above_least = true};

inline constexpr std::size_t kLongestName = 100;   ///< bytes; a title, and part of file names
inline constexpr std::size_t kLongestPath = 1024;  ///< bytes

/// Which whole numbers are allowed.
struct WholeRange {
  int least = 0;
  int most = std::numeric_limits<int>::max();
};

/// A pair [lower, upper] with lower < upper.
struct NumberInterval {
  double lower = -std::numeric_limits<double>::infinity();
  double upper = std::numeric_limits<double>::infinity();
};

/// One mapping of the tree, and its place in the whole. A section that is absent, or no mapping, is
/// empty. Refers to the tree and the problems, which must outlive it.
class Section {
 public:
  Section(const YamlNode& root, Problems& problems);

  /// The mapping under `key`; reading it as one is noted as a problem when it is something else.
  [[nodiscard]] Section section(const std::string& key);
  /// Item `index` of the list that `key` holds, as a mapping.
  [[nodiscard]] Section item(const std::string& key, std::size_t index);
  /// How many items the list under `key` has; 0 without one.
  [[nodiscard]] std::size_t list_size(const std::string& key);

  [[nodiscard]] bool has(const std::string& key) const { return get(key) != nullptr; }
  /// Whether the value of `key` was given on the command line: paths may then be relative to the
  /// working folder, too.
  [[nodiscard]] bool is_override(const std::string& key) const {
    return has(key) && get(key)->from_override;
  }
  /// Whether `key` holds a scalar.
  [[nodiscard]] bool holds_text(const std::string& key);
  /// Whether the section is in the tree, as a mapping.
  [[nodiscard]] bool present() const { return node_ != nullptr; }
  [[nodiscard]] std::vector<std::string> keys() const;

  /// Notes that `key` is missing, unless it is there. `expected` says what it should hold.
  void require(const std::string& key, const std::string& expected);

  [[nodiscard]] double number(const std::string& key, double fallback, NumberRange range = {});
  [[nodiscard]] int whole(const std::string& key, int fallback, WholeRange range);
  [[nodiscard]] std::uint64_t seed(const std::string& key, std::uint64_t fallback);
  [[nodiscard]] bool flag(const std::string& key, bool fallback);
  /// A scalar as it is written, of at most `longest` bytes and without control characters.
  [[nodiscard]] std::string text(const std::string& key, const std::string& fallback,
                                 std::size_t longest);
  /// A list of scalars, each as `text` takes them; empty without one.
  [[nodiscard]] std::vector<std::string> texts(const std::string& key, std::size_t longest);
  /// A scalar that is one of `known`.
  [[nodiscard]] std::string name(const std::string& key, const std::string& fallback,
                                 const std::vector<std::string>& known);
  /// `size` finite numbers.
  [[nodiscard]] std::optional<Eigen::VectorXd> vector(const std::string& key, Eigen::Index size);
  /// Finite numbers, as a list of rows. A list of numbers stands for a diagonal when rows == cols,
  /// and otherwise for the only row when rows == 1.
  [[nodiscard]] std::optional<Eigen::MatrixXd> matrix(const std::string& key, Eigen::Index rows,
                                                      Eigen::Index cols);
  /// [lower, upper], lower < upper; ±infinity is allowed unless `finite`.
  [[nodiscard]] std::optional<NumberInterval> interval(const std::string& key, bool finite);

  /// The value of `key` as it is in the tree; nullptr without one.
  [[nodiscard]] const YamlNode* tree(const std::string& key) { return take(key); }

  /// Notes a problem with what `key` holds (or with this section, if it holds nothing); `found`
  /// defaults to a description of it.
  void note(const std::string& key, const std::string& expected, std::string found = "");

  /// The same of item `index` of the list that `key` holds, or of the list where it is shorter.
  void note_item(const std::string& key, std::size_t index, const std::string& expected,
                 std::string found = "");

  /// Notes a problem with this section as a whole.
  void note_here(const std::string& expected, std::string found);

  /// Notes every key that no reader above has asked for, with the nearest that one has.
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
  const YamlNode* origin_;  // the nearest node that is there, for line numbers
  std::string path_;
  Problems* problems_;
  std::vector<std::string> asked_;
};

/// The number that a scalar holds as YAML writes it (.inf included), or nothing.
[[nodiscard]] std::optional<double> parse_number(const YamlNode& node);

}  // namespace qsmpc::harness
