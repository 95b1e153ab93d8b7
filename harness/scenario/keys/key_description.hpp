// The description of a file's key as plain data: name, values, unit, default and words. It is the
// source of the readers' ranges and names, the documentation's tables and the JSON Schema.
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

/// Names that depend on the scenario's system; `kFree` allows any name.
enum class NameFamily { kNone, kStates, kAngles, kInputs, kParameters, kFree };

/// A number of items that depends on the scenario's system; `kAny` is independent of it.
enum class Dimension { kAny, kStates, kInputs };

/// Any YAML value.
struct AnyValue {};
/// A scalar, verbatim.
struct TextValue {
  std::size_t longest = kLongestPath;  ///< bytes
  std::string what{};     ///< its noun in errors, e.g. "a name", if it may not be empty
  std::string pattern{};  ///< regular expression, for the schema only
};
/// One of `known`.
struct NameValue {
  std::vector<std::string> known{};
};
/// A name that is defined by the scenario's system.
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
/// A list of rows; or a list of numbers, which is a diagonal or the only row.
struct MatrixValue {
  Dimension rows = Dimension::kStates;
  Dimension cols = Dimension::kStates;
  bool is_identity_by_default = false;  ///< else zero; if symmetric, positive semidefinite
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
  bool once = false;     ///< whether items must be distinct
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
  /// of the mapping stand beside the other keys.
  std::string name{};
  NameFamily family = NameFamily::kNone;
  std::vector<KeyValue> values{};  ///< usually one; otherwise alternatives
  /// Markdown, for tables and editors. "{range}", "{names}" and "{longest}" are replaced by the
  /// limits of `values`; a range that is not mentioned is appended.
  std::string words{};
  std::string see{};  ///< Markdown link, for tables only: "[below](#gains)"
  std::string unit{};
  std::string fallback{};        ///< the default, as YAML; empty where there is no single default
  std::string fallback_words{};  ///< shown instead of `fallback` in tables
  bool required = false;
};

/// The values of `key` of the given type; the key must have them.
template <class Value>
[[nodiscard]] const Value& value_of(const KeyDescription& key) {
  return std::get<Value>(key.values.front());
}

/// The mapping that `key` may hold; nullptr if it cannot hold one.
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
