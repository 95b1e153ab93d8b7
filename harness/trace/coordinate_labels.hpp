// Names and units of a system's coordinates, as stored in the attributes of datasets.
#pragma once

#include <string>
#include <vector>

#include "models/dynamics/dynamics.hpp"

namespace qsmpc::harness {

struct CoordinateLabels {
  std::vector<std::string> names;
  std::vector<std::string> units;
};

[[nodiscard]] inline CoordinateLabels labels_of(
    const std::vector<models::Coordinate>& coordinates) {
  CoordinateLabels labels;
  for (const models::Coordinate& coordinate : coordinates) {
    labels.names.push_back(coordinate.name);
    labels.units.push_back(coordinate.unit);
  }
  return labels;
}

}  // namespace qsmpc::harness
