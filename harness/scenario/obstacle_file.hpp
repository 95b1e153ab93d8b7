// Obstacles in a separate file: a list as in the scenario, or GeoJSON.
#pragma once

#include <string>
#include <vector>

#include "controller/regions/safe_set.hpp"
#include "harness/scenario/obstacle_reader.hpp"

namespace qsmpc::harness {

/// The obstacles of the YAML or JSON file `path`: a list of entries as in `safe_set.obstacles`, or
/// a FeatureCollection, Feature, GeometryCollection or geometry of GeoJSON, in metres in the plane
/// of position. Polygons and MultiPolygons become polygons, a Point with a property `radius`
/// becomes a disc; a third coordinate is ignored. Problems are noted with the file's name, line and
/// key; holes and other geometries are problems.
[[nodiscard]] std::vector<controller::Obstacle> read_obstacle_file(const std::string& path,
                                                                   const ObstacleReading& reading);

}  // namespace qsmpc::harness
