#include "harness/scenario/keys/shape_keys.hpp"

#include <algorithm>
#include <stdexcept>

#include <fmt/format.h>

#include "harness/scenario/known_names.hpp"
#include "harness/scenario/yaml_text.hpp"

namespace qsmpc::harness {
namespace {

using controller::PlanarShape;

constexpr const char* kDisc = "disc";
constexpr const char* kEllipse = "ellipse";
constexpr const char* kTurnedBox = "box";
constexpr const char* kPolygon = "polygon";
constexpr const char* kHalfPlane = "half_plane";
constexpr const char* kTwoPlaces = "[x, y], two numbers from -1e7 to 1e7";
constexpr const char* kTwoSizes = "two numbers from 1e-6 to 1e7";

bool is_in(const Eigen::VectorXd& values, const NumberRange& range) {
  return (values.array() >= range.least).all() && (values.array() <= range.most).all();
}

/// A required pair of numbers.
Eigen::Vector2d read_pair(Section& section, const std::string& key, const NumberRange& range,
                          const char* expected) {
  section.require(key, expected);
  const std::optional<Eigen::VectorXd> pair = section.vector(key, 2);
  if (pair && is_in(*pair, range)) return *pair;
  if (pair) section.note(key, expected, yaml_list(*pair));
  return Eigen::Vector2d::Ones();
}

double read_required(Section& section, const std::string& key, const NumberRange& range,
                     const char* expected) {
  section.require(key, expected);
  return section.number(key, 1.0, range);
}

PlanarShape read_disc(Section& disc) {
  return controller::DiscShape{
      .centre = read_pair(disc, "centre", kShapePlaces, kTwoPlaces),
      .radius = read_required(disc, "radius", kShapeSizes, "a number >= 1e-06")};
}

PlanarShape read_ellipse(Section& ellipse) {
  return controller::EllipseShape{
      .centre = read_pair(ellipse, "centre", kShapePlaces, kTwoPlaces),
      .semi_axes = read_pair(ellipse, "semi_axes", kShapeSizes, kTwoSizes),
      .angle = ellipse.number("angle", 0.0, kShapePlaces)};
}

PlanarShape read_turned_box(Section& box) {
  return controller::TurnedBoxShape{.centre = read_pair(box, "centre", kShapePlaces, kTwoPlaces),
                                    .size = read_pair(box, "size", kShapeSizes, kTwoSizes),
                                    .angle = box.number("angle", 0.0, kShapePlaces)};
}

PlanarShape read_half_plane(Section& half_plane) {
  controller::HalfPlaneShape shape{
      .normal = read_pair(half_plane, "normal", kShapePlaces, kTwoPlaces),
      .offset = read_required(half_plane, "offset", {}, "a finite number")};
  const double length = shape.normal.norm();
  if (length < kShapeSizes.least) {
    half_plane.note("normal", "a direction of length at least 1e-06", yaml_list(shape.normal));
  } else if (std::abs(shape.offset) > kShapePlaces.most * length) {
    half_plane.note("offset", "at most 1e7 times the length of the normal");
  }
  return shape;
}

/// Reads from the obstacle itself, since the value is a list of corners rather than a mapping.
std::optional<PlanarShape> read_polygon(Section& obstacle, const std::string& key) {
  const std::size_t count = obstacle.list_size(key);
  const std::string expected =
      fmt::format("3 to {} corners, [x, y] each, of a polygon", kMostCorners);
  if (count < 3 || count > kMostCorners) {
    if (obstacle.tree(key)->kind == YamlNode::Kind::kList) obstacle.note(key, expected);
    return std::nullopt;
  }
  const auto rows = obstacle.matrix(key, static_cast<Eigen::Index>(count), 2);
  if (!rows) return std::nullopt;
  return checked_polygon(obstacle, key, rows->transpose());
}

struct ShapeReader {
  const char* name;
  PlanarShape (*read)(Section&);
};
constexpr ShapeReader kReaders[] = {{kDisc, read_disc},
                                    {kEllipse, read_ellipse},
                                    {kTurnedBox, read_turned_box},
                                    {kHalfPlane, read_half_plane}};

KeyDescription pair_key(const char* name, const char* words, const NumberRange& range) {
  return {.name = name,
          .values = {VectorValue{.size = Dimension::kAny, .length = 2, .range = range}},
          .words = words,
          .unit = "m",
          .required = true};
}

KeyDescription angle_key(const char* words) {
  return {.name = "angle",
          .values = {NumberValue{kShapePlaces}},
          .words = words,
          .unit = "rad",
          .fallback = "0"};
}

KeyDescription centre_key() { return pair_key("centre", "its centre", kShapePlaces); }

KeyDescription shape_key(const char* name, const char* words, std::vector<KeyDescription> keys) {
  return {.name = name, .values = {MappingValue{std::move(keys)}}, .words = words};
}

/// Whether the key means a state with the name of a shape: its value is [lower, upper].
bool is_interval(const YamlNode& value) {
  return value.kind == YamlNode::Kind::kList &&
         std::ranges::all_of(
             value.items, [](const YamlNode& item) { return item.kind != YamlNode::Kind::kList; });
}

struct ShapeText {
  std::string operator()(const controller::DiscShape& disc) const {
    return fmt::format("{}: {{centre: {}, radius: {}}}", kDisc, yaml_list(disc.centre),
                       yaml_number(disc.radius));
  }
  std::string operator()(const controller::EllipseShape& ellipse) const {
    return fmt::format("{}: {{centre: {}, semi_axes: {}, angle: {}}}", kEllipse,
                       yaml_list(ellipse.centre), yaml_list(ellipse.semi_axes),
                       yaml_number(ellipse.angle));
  }
  std::string operator()(const controller::TurnedBoxShape& box) const {
    return fmt::format("{}: {{centre: {}, size: {}, angle: {}}}", kTurnedBox, yaml_list(box.centre),
                       yaml_list(box.size), yaml_number(box.angle));
  }
  std::string operator()(const controller::PolygonShape& polygon) const {
    return fmt::format("{}: {}", kPolygon, yaml_rows(polygon.corners.transpose()));
  }
  std::string operator()(const controller::HalfPlaneShape& half_plane) const {
    return fmt::format("{}: {{normal: {}, offset: {}}}", kHalfPlane, yaml_list(half_plane.normal),
                       yaml_number(half_plane.offset));
  }
};

}  // namespace

std::vector<KeyDescription> shape_keys() {
  const KeyDescription radius{.name = "radius",
                              .values = {NumberValue{kShapeSizes}},
                              .words = "its radius",
                              .unit = "m",
                              .required = true};
  const KeyDescription offset{.name = "offset",
                              .values = {NumberValue{}},
                              .words = "offset of the edge along the normal",
                              .unit = "m",
                              .required = true};
  const VectorValue corner{.size = Dimension::kAny, .length = 2, .range = kShapePlaces};
  return {
      shape_key(kDisc, "a disc", {centre_key(), radius}),
      shape_key(kEllipse, "an ellipse",
                {centre_key(), pair_key("semi_axes", "half its length and width", kShapeSizes),
                 angle_key("angle from the x axis to the first of them")}),
      shape_key(kTurnedBox, "a rectangle",
                {centre_key(), pair_key("size", "its length and width", kShapeSizes),
                 angle_key("angle from the x axis to its length")}),
      {.name = kPolygon,
       .values = {list_of_values(corner, {.least = 3, .most = kMostCorners})},
       .words =
           "the corners of a polygon in order; it may be concave, but must not intersect itself"},
      shape_key(
          kHalfPlane, "all points p with normal · p ≥ offset",
          {pair_key("normal", "normal into the unsafe side, of any length except 0", kShapePlaces),
           offset})};
}

const std::vector<std::string>& shape_names() {
  static const std::vector<std::string> names{kDisc, kEllipse, kTurnedBox, kPolygon, kHalfPlane};
  return names;
}

std::vector<std::string> named_shapes(Section& obstacle,
                                      const std::vector<models::Coordinate>& states) {
  const std::vector<std::string> known = coordinate_names(states);
  std::vector<std::string> named;
  for (const std::string& name : shape_names()) {
    const YamlNode* value = obstacle.tree(name);
    if (value == nullptr) continue;
    const bool is_state = std::ranges::find(known, name) != known.end();
    if (!is_state || !is_interval(*value)) named.push_back(name);
  }
  return named;
}

std::optional<PlanarShape> read_shape(Section& obstacle, const std::string& name) {
  if (name == kPolygon) return read_polygon(obstacle, name);
  const auto* const reader =
      std::ranges::find_if(kReaders, [&](const ShapeReader& one) { return one.name == name; });
  Section section = obstacle.section(name);
  if (!section.present()) return std::nullopt;
  const PlanarShape shape = reader->read(section);
  section.refuse_unread();
  try {
    controller::check_planar_shape(shape);
  } catch (const std::invalid_argument& refusal) {
    section.note_here(refusal.what(), "another shape");
    return std::nullopt;
  }
  return shape;
}

std::optional<PlanarShape> checked_polygon(Section& section, const std::string& key,
                                           const Eigen::Matrix2Xd& corners) {
  if (!is_in(corners.reshaped(), kShapePlaces)) {
    section.note(key, "corners with numbers from -1e7 to 1e7",
                 fmt::format("{:g}", corners.cwiseAbs().maxCoeff()));
    return std::nullopt;
  }
  const std::string wrong = controller::why_no_polygon(corners);
  if (wrong.empty()) return controller::PolygonShape{.corners = corners};
  section.note(key, wrong);
  return std::nullopt;
}

std::string shape_text(const PlanarShape& shape) {
  return "{" + std::visit(ShapeText{}, shape) + "}";
}

}  // namespace qsmpc::harness
