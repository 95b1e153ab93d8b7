#include "harness/trace/system_group.hpp"

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "harness/errors.hpp"
#include "harness/trace/coordinate_labels.hpp"
#include "harness/trace/rows.hpp"

namespace qsmpc::harness {
namespace {

constexpr const char* kSystem = "/system";
constexpr const char* kStates = "/system/states";
constexpr const char* kInputs = "/system/inputs";

struct DrawnState {
  const char* name;  // of the attribute
  int models::SystemDescription::*member;
};

constexpr std::array<DrawnState, 3> kDrawnStates = {{
    {"position_x", &models::SystemDescription::position_x},
    {"position_y", &models::SystemDescription::position_y},
    {"heading", &models::SystemDescription::heading},
}};

void write_coordinates(Hdf5File& file, const char* group,
                       const std::vector<models::Coordinate>& coordinates) {
  const CoordinateLabels labels = labels_of(coordinates);
  std::vector<std::string> angles;
  for (const models::Coordinate& coordinate : coordinates) {
    if (coordinate.is_angle) angles.push_back(coordinate.name);
  }
  file.create_group(group);
  file.set_texts(group, "names", labels.names);
  file.set_texts(group, "units", labels.units);
  file.set_texts(group, "angles", angles);
}

[[noreturn]] void refuse(const Hdf5File& file, const std::string& key, const std::string& found,
                         const std::string& expected) {
  throw InputError({.file = file.path(), .key = key, .found = found, .expected = expected});
}

void expect_one_each(const Hdf5File& file, const std::string& key, std::size_t found,
                     std::size_t names) {
  if (found != names) refuse(file, key, std::to_string(found), std::to_string(names));
}

std::vector<models::Coordinate> read_coordinates(const Hdf5File& file, const std::string& group) {
  const std::vector<std::string> names = file.texts(group, "names");
  const std::vector<std::string> units = file.texts(group, "units");
  const std::vector<std::string> angles = file.texts(group, "angles");
  expect_one_each(file, group + "@units", units.size(), names.size());
  std::vector<models::Coordinate> coordinates;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const bool is_angle = std::ranges::find(angles, names[i]) != angles.end();
    coordinates.push_back({.name = names[i], .unit = units[i], .is_angle = is_angle});
  }
  return coordinates;
}

Eigen::VectorXd read_bounds(const Hdf5File& file, const char* name, std::size_t inputs) {
  const std::vector<double> bounds = file.numbers(kInputs, name);
  expect_one_each(file, std::string(kInputs) + "@" + name, bounds.size(), inputs);
  return Eigen::Map<const Eigen::VectorXd>(bounds.data(), std::ssize(bounds));
}

}  // namespace

void write_system(Hdf5File& file, const models::SystemDescription& system) {
  write_coordinates(file, kStates, system.states);
  write_coordinates(file, kInputs, system.inputs);
  file.set_numbers(kInputs, "lower", by_rows(system.input_lower));
  file.set_numbers(kInputs, "upper", by_rows(system.input_upper));
  file.set_text(kSystem, "name", system.name);
  file.set_text(kSystem, "summary", system.summary);
  for (const DrawnState& drawn : kDrawnStates) {
    file.set_integer(kSystem, drawn.name, system.*drawn.member);
  }
}

bool has_system(const Hdf5File& file) { return file.has_group(kSystem); }

models::SystemDescription read_system(const Hdf5File& file) {
  models::SystemDescription system;
  system.name = file.text(kSystem, "name");
  system.summary = file.text(kSystem, "summary");
  system.states = read_coordinates(file, kStates);
  system.inputs = read_coordinates(file, kInputs);
  system.input_lower = read_bounds(file, "lower", system.inputs.size());
  system.input_upper = read_bounds(file, "upper", system.inputs.size());
  for (const DrawnState& drawn : kDrawnStates) {
    const std::int64_t index = file.integer(kSystem, drawn.name);
    if (index < -1 || index >= std::ssize(system.states)) {
      refuse(file, std::string(kSystem) + "@" + drawn.name, std::to_string(index),
             "-1 or the index of a state, counted from 0");
    }
    system.*drawn.member = static_cast<int>(index);
  }
  return system;
}

}  // namespace qsmpc::harness
