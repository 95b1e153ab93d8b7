#include "harness/scenario/obstacle_file.hpp"

#include <cmath>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "harness/errors.hpp"
#include "harness/files/text_file.hpp"
#include "harness/scenario/keys/shape_keys.hpp"
#include "harness/scenario/known_names.hpp"
#include "harness/scenario/yaml_tree.hpp"

namespace qsmpc::harness {
namespace {

using controller::Obstacle;

constexpr const char* kType = "type";
constexpr const char* kCoordinates = "coordinates";

/// A node of the file and its dotted path.
struct PlacedNode {
  const YamlNode& node;
  std::string path;

  [[nodiscard]] bool is_list() const { return node.kind == YamlNode::Kind::kList; }
  [[nodiscard]] PlacedNode item(std::size_t index) const {
    return {node.items[index], fmt::format("{}.{}", path, index)};
  }
};

/// Reads the obstacles of a GeoJSON document.
class GeoJson {
 public:
  GeoJson(Problems& problems, std::size_t most) : problems_(problems), most_(most) {}

  void read(Section& object) {
    const YamlNode* type = object.tree(kType);
    const std::string name =
        type != nullptr && type->kind == YamlNode::Kind::kText ? type->text : "";
    if (name == "FeatureCollection") return read_each(object, "features");
    if (name == "GeometryCollection") return read_each(object, "geometries");
    if (name == "Feature") return read_feature(object);
    if (name == "Polygon") return read_polygon(coordinates(object));
    if (name == "MultiPolygon") return read_polygons(object);
    if (name == "Point") return read_disc(object);
    static const std::vector<std::string> known{
        "FeatureCollection", "GeometryCollection", "Feature", "Polygon", "MultiPolygon", "Point"};
    object.note(kType, expected_names(name, known));
  }

  [[nodiscard]] std::vector<Obstacle> take() { return std::move(obstacles_); }

 private:
  void read_each(Section& object, const char* key) {
    object.require(key, "a list");
    const std::size_t count = object.list_size(key);
    if (count == 0 && object.tree(key) != nullptr &&
        object.tree(key)->kind == YamlNode::Kind::kList) {
      object.note(key, "at least one that becomes an obstacle", "an empty list");
    }
    for (std::size_t i = 0; i < count; ++i) {
      Section item = object.item(key, i);
      if (item.present()) read(item);
    }
  }

  void read_feature(Section& feature) {
    radius_ = nullptr;
    const YamlNode* properties = feature.tree("properties");
    if (properties != nullptr && properties->kind == YamlNode::Kind::kMap) {
      radius_ = properties->find("radius");
    }
    feature.require("geometry", "a geometry");
    Section geometry = feature.section("geometry");
    if (geometry.present()) read(geometry);
    radius_ = nullptr;
  }

  /// The coordinates, which must be a list.
  std::optional<PlacedNode> coordinates(Section& geometry) {
    geometry.require(kCoordinates, "a list");
    const YamlNode* list = geometry.tree(kCoordinates);
    if (list == nullptr) return std::nullopt;
    PlacedNode placed{*list, geometry.path_of(kCoordinates)};
    if (!placed.is_list()) {
      note(placed, "a list");
      return std::nullopt;
    }
    return placed;
  }

  void read_polygons(Section& geometry) {
    const std::optional<PlacedNode> polygons = coordinates(geometry);
    if (!polygons) return;
    for (std::size_t i = 0; i < polygons->node.items.size(); ++i) read_polygon(polygons->item(i));
  }

  /// A list of rings, the outer one first.
  void read_polygon(const std::optional<PlacedNode>& rings) {
    if (!rings) return;
    if (!rings->is_list() || rings->node.items.empty()) return note(*rings, "a list of rings");
    if (rings->node.items.size() > 1) {
      return note(rings->item(1),
                  "one ring: cut a polygon with a hole into polygons without holes, e.g. one on "
                  "either side of a line through the hole",
                  "a hole");
    }
    const PlacedNode ring = rings->item(0);
    if (!ring.is_list()) return note(ring, "a list of positions");
    std::vector<Eigen::Vector2d> corners;
    for (std::size_t i = 0; i < ring.node.items.size(); ++i) {
      const std::optional<Eigen::Vector2d> corner = position(ring.item(i));
      if (!corner) return;
      corners.push_back(*corner);
    }
    if (corners.size() > 1 && corners.front() == corners.back()) corners.pop_back();
    if (corners.size() < 3 || corners.size() > kMostCorners) {
      return note(ring, fmt::format("3 to {} corners", kMostCorners),
                  fmt::format("{} corners", corners.size()));
    }
    controller::PolygonShape polygon{.corners = Eigen::Matrix2Xd(2, std::ssize(corners))};
    for (Eigen::Index i = 0; i < polygon.corners.cols(); ++i) {
      polygon.corners.col(i) = corners[static_cast<std::size_t>(i)];
    }
    const std::string wrong = controller::why_no_polygon(polygon.corners);
    if (!wrong.empty()) return note(ring, wrong);
    add(ring, std::move(polygon));
  }

  void read_disc(Section& point) {
    const std::optional<PlacedNode> place = coordinates(point);
    if (!place) return;
    const std::optional<double> radius = radius_ == nullptr ? std::nullopt : parse_number(*radius_);
    if (!radius || !(*radius >= kShapeSizes.least && *radius <= kShapeSizes.most)) {
      const PlacedNode about = radius_ == nullptr ? *place : PlacedNode{*radius_, place->path};
      return note(
          about, "a Feature whose properties have a radius, a number from 1e-6 to 1e7",
          radius_ == nullptr ? "a Point without a radius" : "the radius " + describe(*radius_));
    }
    const std::optional<Eigen::Vector2d> centre = position(*place);
    if (centre) add(*place, controller::DiscShape{.centre = *centre, .radius = *radius});
  }

  std::optional<Eigen::Vector2d> position(const PlacedNode& placed) {
    const std::vector<YamlNode>& items = placed.node.items;
    if (!placed.is_list() || items.size() < 2 || items.size() > 3) {
      note(placed, "a position, [x, y] in metres");
      return std::nullopt;
    }
    const std::optional<double> x = parse_number(items[0]);
    const std::optional<double> y = parse_number(items[1]);
    const auto is_place = [](const std::optional<double>& value) {
      return value && std::abs(*value) <= kShapePlaces.most;
    };
    for (std::size_t i = 0; i < 2; ++i) {
      if (is_place(i == 0 ? x : y)) continue;
      note(placed.item(i), "a number from -1e7 to 1e7, in metres");
      return std::nullopt;
    }
    return Eigen::Vector2d(*x, *y);
  }

  void add(const PlacedNode& from, controller::PlanarShape shape) {
    if (obstacles_.size() == most_) {
      note(from,
           fmt::format("at most {} obstacles including those of the scenario", kMostObstacles),
           "one more");
    }
    if (obstacles_.size() <= most_) obstacles_.emplace_back(std::move(shape));
  }

  void note(const PlacedNode& placed, const std::string& expected, std::string found = "") {
    if (found.empty()) found = describe(placed.node);
    problems_.add(placed.node, placed.path, std::move(found), expected);
  }

  Problems& problems_;
  std::size_t most_;
  const YamlNode* radius_ = nullptr;  // of the current feature
  std::vector<Obstacle> obstacles_{};
};

std::vector<Obstacle> obstacles_in(const YamlNode& tree, const ObstacleReading& reading) {
  if (tree.kind == YamlNode::Kind::kList) {
    if (tree.items.empty()) {
      reading.problems.add(tree, "", "an empty list", "at least one obstacle");
      return {};
    }
    YamlNode root{.kind = YamlNode::Kind::kMap, .line = tree.line};
    root.keys = {"obstacles"};
    root.items = {tree};
    Section section(root, reading.problems);
    return read_obstacles(section, "obstacles", reading);
  }
  if (tree.find(kType) == nullptr) {
    reading.problems.add(tree, "", describe(tree),
                         "a list of obstacles, or GeoJSON, a mapping with a type");
    return {};
  }
  Section section(tree, reading.problems);
  if (!has_plane(reading.system)) {
    section.note(kType, "a list of boxes, because the system has no position in the plane");
    return {};
  }
  GeoJson document(reading.problems, reading.most);
  document.read(section);
  return document.take();
}

}  // namespace

std::vector<Obstacle> read_obstacle_file(const std::string& path, const ObstacleReading& reading) {
  try {
    const YamlNode tree = parse_yaml(read_text_file(path), path);
    Problems own(path);
    std::vector<Obstacle> obstacles =
        obstacles_in(tree, {.system = reading.system, .problems = own, .most = reading.most});
    for (InputError::Where& where : own.sorted()) reading.problems.add(std::move(where));
    return obstacles;
  } catch (const InputError& error) {
    reading.problems.add(error.where());
    return {};
  }
}

}  // namespace qsmpc::harness
