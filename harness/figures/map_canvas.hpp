// A drawing of the plane as inline SVG: equal axes with numbers, metres to the view box.
#pragma once

#include <string>

#include "harness/figures/axis.hpp"

namespace qsmpc::harness {

struct MapPoint {
  double x = 0.0;
  double y = 0.0;
};

[[nodiscard]] bool is_drawable(const MapPoint& point);

struct MapRectangle {
  double x_lower = 0.0;
  double x_upper = 0.0;
  double y_lower = 0.0;
  double y_upper = 0.0;
};

/// The whole plane: all sides are infinite.
[[nodiscard]] MapRectangle unbounded_plane();

struct MapTexts {
  std::string title;
  std::string x_label;
  std::string y_label;
};

struct MapSize {
  double width = 0.0;
  double height = 0.0;
};

/// How the plane maps to the view box of the map proper: (x − x_left) · scale from the left, (y_top
/// − y) · scale from the top.
struct MapView {
  double x_left = 0.0;
  double y_top = 0.0;
  double scale = 1.0;  ///< view box units per metre
};

class MapCanvas {
 public:
  /// Shows `area`, whose sides are finite and have non-zero length, and more than it if the map
  /// would otherwise be too flat or too tall.
  explicit MapCanvas(const MapRectangle& area);

  /// The place of a drawable point of the plane in the view box, from the left and from the top.
  [[nodiscard]] MapPoint place(const MapPoint& point) const;
  [[nodiscard]] MapView view() const { return {x_.lower, y_.upper, scale_}; }
  /// The part of the plane that is shown.
  [[nodiscard]] MapRectangle area() const { return {x_.lower, x_.upper, y_.lower, y_.upper}; }
  /// Length in the view box of a length in the plane.
  [[nodiscard]] double length(double metres) const { return metres * scale_; }

  /// "3.2 7.1", for path data.
  [[nodiscard]] std::string coordinates(const MapPoint& point) const;
  /// The same for a result of `place`.
  [[nodiscard]] static std::string written(const MapPoint& place);
  /// The visible part of `rectangle`, whose sides may be infinite; empty if none is visible.
  [[nodiscard]] std::string rectangle(const std::string& classes,
                                      const MapRectangle& rectangle) const;

  /// Size of the map proper, and of the whole drawing, in view box units.
  [[nodiscard]] MapSize inner_size() const { return {.width = width_, .height = height_}; }
  [[nodiscard]] MapSize size() const;

  /// The whole drawing: `content`, clipped to the map, with the axes around it. Texts are escaped.
  /// `place` holds attributes of the <svg>, such as its position.
  [[nodiscard]] std::string svg(const std::string& content, const MapTexts& texts,
                                const std::string& place = {}) const;

 private:
  [[nodiscard]] std::string axes(const std::string& x_label, const std::string& y_label) const;

  Axis x_;
  Axis y_;
  double scale_ = 1.0;  // view box units per metre
  double width_ = 0.0;  // of the map proper, in view box units
  double height_ = 0.0;
};

}  // namespace qsmpc::harness
