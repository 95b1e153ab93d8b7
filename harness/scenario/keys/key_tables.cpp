#include "harness/scenario/keys/key_tables.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "harness/scenario/keys/key_words.hpp"
#include "harness/scenario/keys/scenario_key.hpp"
#include "harness/scenario/plant_mapping_keys.hpp"
#include "harness/text/unit_text.hpp"
#include "models/dynamics/dynamics.hpp"

namespace qsmpc::harness {
namespace {

constexpr double kAnyControlPeriod = 0.1;  // s; the tables do not depend on it

struct KeyRow {
  std::string path;
  std::string words;
  std::string unit;
  std::string fallback;
};

std::string default_cell(const KeyDescription& key) {
  if (key.required) return "required";
  if (!key.fallback_words.empty()) return key.fallback_words;
  const bool is_word = !key.values.empty() && std::holds_alternative<NameValue>(key.values.front());
  return is_word ? "`" + key.fallback + "`" : key.fallback;
}

KeyRow row_of(const KeyDescription& key, const std::string& path) {
  std::string words = filled_words(key);
  if (!key.see.empty()) words += ", see " + key.see;
  return {.path = path, .words = std::move(words), .unit = key.unit, .fallback = default_cell(key)};
}

void add_rows(std::vector<KeyRow>& rows, const std::vector<KeyDescription>& keys,
              const std::string& folder) {
  for (const KeyDescription& key : keys) {
    const MappingValue* mapping = mapping_of(key);
    if (key.name.empty()) {
      // Keys whose table is elsewhere share a row.
      std::string paths;
      for (const KeyDescription& inner : mapping->keys) {
        paths += (paths.empty() ? "" : "`, `") + folder + inner.name;
      }
      rows.push_back(row_of(key, paths));
      continue;
    }
    const std::string path = folder + key.name;
    if (!key.words.empty()) rows.push_back(row_of(key, path));
    if (mapping != nullptr && key.family == NameFamily::kNone) {
      add_rows(rows, mapping->keys, path + ".");
    }
  }
}

std::string printed_number(double value) {
  return fmt::format("{}{}", value < 0.0 ? "−" : "", std::abs(value));
}

/// The same with six digits, for a value that may be a fraction of π.
std::string printed_bound(double value) {
  return fmt::format("{}{:.6g}", value < 0.0 ? "−" : "", std::abs(value));
}

std::string coordinates_cell(const std::vector<models::Coordinate>& coordinates) {
  std::string cell;
  for (std::size_t i = 0; i < coordinates.size(); ++i) {
    const models::Coordinate& one = coordinates[i];
    const bool is_last_of_unit = i + 1 == coordinates.size() || coordinates[i + 1].unit != one.unit;
    cell += fmt::format("{}`{}`", i == 0 ? "" : ", ", one.name);
    if (is_last_of_unit) cell += " (" + printed_unit(one.unit) + ")";
  }
  return cell;
}

std::string inputs_cell(const models::SystemDescription& system) {
  std::string cell;
  for (std::size_t i = 0; i < system.inputs.size(); ++i) {
    const models::Coordinate& input = system.inputs[i];
    const double lower = system.input_lower[static_cast<Eigen::Index>(i)];
    const double upper = system.input_upper[static_cast<Eigen::Index>(i)];
    const std::string bounds = lower == -upper
                                   ? "±" + printed_bound(upper)
                                   : printed_bound(lower) + " to " + printed_bound(upper);
    cell += fmt::format("{}`{}` {} {}", i == 0 ? "" : ", ", input.name, bounds,
                        printed_unit(input.unit));
  }
  return cell;
}

std::string constants_cell(const models::SystemEntry& entry) {
  std::string cell;
  for (const auto& [name, value] : entry.defaults) {
    cell += fmt::format("{}`{}` {} {}", cell.empty() ? "" : ", ", name, printed_number(value),
                        printed_unit(entry.units.at(name)));
  }
  return cell.empty() ? "none" : cell;
}

}  // namespace

std::string key_table(const std::vector<KeyDescription>& keys) {
  std::vector<KeyRow> rows;
  add_rows(rows, keys, "");
  const bool has_units =
      std::ranges::any_of(rows, [](const KeyRow& row) { return !row.unit.empty(); });
  std::string out = has_units ? "| key | value | unit | default |\n| --- | --- | --- | --- |\n"
                              : "| key | value | default |\n| --- | --- | --- |\n";
  const auto cell = [](const std::string& text) { return text.empty() ? " |" : " " + text + " |"; };
  for (const KeyRow& row : rows) {
    out += "|" + cell("`" + row.path + "`") + cell(row.words);
    if (has_units) out += cell(row.unit);
    out += cell(row.fallback) + "\n";
  }
  return out;
}

std::string system_table() {
  std::string out =
      "| system | states | inputs, default bounds | constants, defaults |\n"
      "| --- | --- | --- | --- |\n";
  for (const models::SystemEntry& entry : models::systems()) {
    const auto dynamics = models::make_dynamics(entry.name, {}, kAnyControlPeriod);
    const models::SystemDescription& system = dynamics->description();
    out += fmt::format("| `{}` | {} | {} | {} |\n", entry.name, coordinates_cell(system.states),
                       inputs_cell(system), constants_cell(entry));
  }
  return out;
}

std::vector<DocumentTable> scenario_tables() {
  const std::string file = "docs/scenario.md";
  std::vector<std::pair<std::string, std::vector<KeyDescription>>> parts;
  for (const ScenarioKey& key : scenario_keys()) {
    auto part = std::ranges::find(parts, key.table, [](const auto& one) { return one.first; });
    if (part == parts.end()) part = parts.insert(parts.end(), {key.table, {}});
    part->second.push_back(describe(key));
  }
  std::vector<DocumentTable> tables;
  tables.reserve(parts.size() + 2);
  for (const auto& [name, keys] : parts) {
    tables.push_back({.file = file, .name = name, .text = key_table(keys)});
  }
  tables.push_back({.file = file, .name = "systems", .text = system_table()});
  tables.push_back(
      {.file = "docs/plants.md", .name = "mapping", .text = key_table(plant_mapping_keys())});
  return tables;
}

}  // namespace qsmpc::harness
