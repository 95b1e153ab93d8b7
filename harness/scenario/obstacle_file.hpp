// Obstacles in a file of their own: a list as in the scenario, or GeoJSON.
#pragma once

#include <string>
#include <vector>

#include "controller/regions/safe_set.hpp"
#include "harness/scenario/obstacle_reader.hpp"

namespace qsmpc::harness {

/// The obstacles of the YAML or JSON file `path`: a list of entries as `safe_set.obstacles` has
/// them, or a FeatureCollection, Feature, GeometryCollection or geometry of GeoJSON, in metres of
/// the plane of position. Polygons and MultiPolygons are polygons, a Point with a property `radius`
/// is a disc; a third coordinate is passed over. What is wrong is noted with the file's name, line
/// and key, holes and other geometries included.
[[nodiscard]] std::vector<controller::Obstacle> read_obstacle_file(const std::string& path,
                                                                   const ObstacleReading& reading);

}  // namespace qsmpc::harness
