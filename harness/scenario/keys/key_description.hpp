// What a key of a file is, as plain data: name, values, unit, default and words. Readers take
// ranges and names from it; the tables of the documentation and the JSON Schema are made from it.
//
//   const KeyDescription horizon{.name = "horizon",
//                                .values = {WholeValue{1, 1000}},
//                                .words = "steps that are planned ahead",
//                                .fallback = "8"};
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <variant>
#include <vector>

#include "harness/scenario/yaml_section.hpp"

namespace qsmpc::harness {

struct KeyDescription;

/// Names that depend on the scenario's system; `kFree` are any.
enum class NameFamily { kNone, kStates, kAngles, kInputs, kParameters, kFree };

/// A number of items that depends on the scenario's system; `kAny` does not.
enum class Dimension { kAny, kStates, kInputs };

/// Anything that YAML can say.
struct AnyValue {};
/// A scalar as it is written.
struct TextValue {
  std::size_t longest = kLongestPath;  ///< bytes
  std::string what{};     ///< "a name": what errors call one that may not be empty; else it may
  std::string pattern{};  ///< regular expression, for the schema only
};
/// One of `known`.
struct NameValue {
  std::vector<std::string> known{};
};
/// A name that the scenario's system has.
struct SystemNameValue {
  NameFamily family = NameFamily::kNone;
};
struct NumberValue {
  NumberRange range{};
};
struct WholeValue {
  std::uint64_t least = 0;
  std::uint64_t most = std::numeric_limits<std::uint64_t>::max();
};
struct FlagValue {};
/// A list of finite numbers.
struct VectorValue {
  Dimension size = Dimension::kStates;
  std::size_t length = 0;  ///< where the size is kAny; 0: any
  NumberRange range{};
};
/// A list of rows, or of numbers: a diagonal, or the only row.
struct MatrixValue {
  Dimension rows = Dimension::kStates;
  Dimension cols = Dimension::kStates;
  bool is_identity_by_default = false;  ///< else zero; of a symmetric, positive semidefinite one
};
/// [lower, upper].
struct IntervalValue {
  bool finite = false;
};
struct MappingValue {
  std::vector<KeyDescription> keys;
};
struct ListLimits {
  std::size_t least = 0;
  std::size_t most = 0;  ///< 0: any number
  bool once = false;     ///< whether no item may be there twice
};
struct ListValue {
  std::vector<KeyDescription> item;  ///< exactly one, without a name
  ListLimits limits{};
};

using KeyValue =
    std::variant<AnyValue, TextValue, NameValue, SystemNameValue, NumberValue, WholeValue,
                 FlagValue, VectorValue, MatrixValue, IntervalValue, MappingValue, ListValue>;

struct KeyDescription {
  /// As in the file. A word in capitals stands for each name of `family`; without a name, the keys
  /// of its mapping stand beside the others.
  std::string name{};
  NameFamily family = NameFamily::kNone;
  std::vector<KeyValue> values{};  ///< usually one, else any of them
  /// Markdown, for tables and editors. "{range}", "{names}" and "{longest}" stand for what the
  /// values say; a range that is not mentioned is appended.
  std::string words{};
  std::string see{};  ///< Markdown link, for tables only: "[below](#gains)"
  std::string unit{};
  std::string fallback{};        ///< the default, as YAML; empty where there is no single one
  std::string fallback_words{};  ///< instead of it in tables
  bool required = false;
};

/// The values of `key` of the given type; the key must have them.
template <class Value>
[[nodiscard]] const Value& value_of(const KeyDescription& key) {
  return std::get<Value>(key.values.front());
}

/// The mapping that `key` may hold; nullptr if it is not one.
[[nodiscard]] inline const MappingValue* mapping_of(const KeyDescription& key) {
  for (const KeyValue& value : key.values) {
    if (const auto* mapping = std::get_if<MappingValue>(&value)) return mapping;
  }
  return nullptr;
}

/// A list of `item`.
[[nodiscard]] inline ListValue list_of_values(KeyValue item, ListLimits limits = {}) {
  return {{KeyDescription{.values = {std::move(item)}}}, limits};
}

}  // namespace qsmpc::harness
