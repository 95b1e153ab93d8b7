#include "harness/figures/map_canvas.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "harness/text/html.hpp"

namespace qsmpc::harness {
namespace {

// Units of the view box.
constexpr double kMapWidth = 480.0;
constexpr double kLeft = 58.0;
constexpr double kRight = 12.0;
constexpr double kTop = 10.0;
constexpr double kBottom = 46.0;
constexpr double kFlattest = 0.35;  // height to width
constexpr double kTallest = 1.25;
constexpr int kTicksAlongWidth = 8;

void widen(Axis& axis, double span) {
  const double margin = 0.5 * (span - (axis.upper - axis.lower));
  axis.lower -= margin;
  axis.upper += margin;
}

}  // namespace

bool is_drawable(const MapPoint& point) { return is_drawable(point.x) && is_drawable(point.y); }

MapRectangle unbounded_plane() {
  constexpr double kFar = std::numeric_limits<double>::infinity();
  return {.x_lower = -kFar, .x_upper = kFar, .y_lower = -kFar, .y_upper = kFar};
}

MapCanvas::MapCanvas(const MapRectangle& area)
    : x_{.lower = area.x_lower, .upper = area.x_upper},
      y_{.lower = area.y_lower, .upper = area.y_upper} {
  const double across = x_.upper - x_.lower;
  const double up = y_.upper - y_.lower;
  if (up < kFlattest * across) widen(y_, kFlattest * across);
  if (up > kTallest * across) widen(x_, up / kTallest);
  width_ = kMapWidth;
  scale_ = width_ / (x_.upper - x_.lower);
  height_ = (y_.upper - y_.lower) * scale_;
}

MapPoint MapCanvas::place(const MapPoint& point) const {
  // Far outside the map, where nothing is visible, clamp to numbers that every renderer accepts.
  constexpr double kFarOutside = 1e5;  // view box units
  const double x = position_on(x_, point.x) * width_;
  const double y = (1.0 - position_on(y_, point.y)) * height_;
  return {.x = std::clamp(x, -kFarOutside, kFarOutside),
          .y = std::clamp(y, -kFarOutside, kFarOutside)};
}

std::string MapCanvas::coordinates(const MapPoint& point) const { return written(place(point)); }

std::string MapCanvas::written(const MapPoint& place) {
  return fmt::format("{:.1f} {:.1f}", place.x, place.y);
}

std::string MapCanvas::rectangle(const std::string& classes, const MapRectangle& rectangle) const {
  const MapPoint low = place({.x = std::clamp(rectangle.x_lower, x_.lower, x_.upper),
                              .y = std::clamp(rectangle.y_lower, y_.lower, y_.upper)});
  const MapPoint high = place({.x = std::clamp(rectangle.x_upper, x_.lower, x_.upper),
                               .y = std::clamp(rectangle.y_upper, y_.lower, y_.upper)});
  if (!(high.x > low.x) || !(low.y > high.y)) return {};
  return fmt::format(
      "<rect class=\"{}\" x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\"/>", classes,
      low.x, high.y, high.x - low.x, low.y - high.y);
}

std::string MapCanvas::axes(const std::string& x_label, const std::string& y_label) const {
  const double step = tick_step(x_.upper - x_.lower, kTicksAlongWidth);
  std::string svg =
      fmt::format("<rect class=\"frame\" x=\"{}\" y=\"{}\" width=\"{:.1f}\" height=\"{:.1f}\"/>",
                  kLeft, kTop, width_, height_);
  const double foot = kTop + height_;
  for (const Tick& tick : ticks_every(x_, step)) {
    const double at = kLeft + position_on(x_, tick.value) * width_;
    svg += fmt::format("<path class=\"axis\" d=\"M{:.1f} {:.1f}v5\"/>", at, foot);
    svg += fmt::format("<text class=\"middle\" x=\"{:.1f}\" y=\"{:.1f}\">{}</text>", at,
                       foot + 18.0, escape_html(tick.label));
  }
  for (const Tick& tick : ticks_every(y_, step)) {
    const double at = foot - position_on(y_, tick.value) * height_;
    svg += fmt::format("<path class=\"axis\" d=\"M{:.1f} {:.1f}h-5\"/>", kLeft, at);
    svg += fmt::format("<text class=\"end\" x=\"{:.1f}\" y=\"{:.1f}\">{}</text>", kLeft - 8.0,
                       at + 4.0, escape_html(tick.label));
  }
  svg += fmt::format("<text class=\"middle label\" x=\"{:.1f}\" y=\"{:.1f}\">{}</text>",
                     kLeft + width_ / 2.0, foot + 38.0, escape_html(x_label));
  svg += fmt::format(
      "<text class=\"middle label\" transform=\"translate(14 {:.1f}) rotate(-90)\">{}</text>",
      kTop + height_ / 2.0, escape_html(y_label));
  return svg;
}

MapSize MapCanvas::size() const {
  return {.width = kLeft + width_ + kRight, .height = kTop + height_ + kBottom};
}

std::string MapCanvas::svg(const std::string& content, const MapTexts& texts,
                           const std::string& place) const {
  // An inner <svg> clips its content to its own size.
  return fmt::format(
      "<svg{} viewBox=\"0 0 {:.1f} {:.1f}\" role=\"img\" aria-label=\"{}\">\n"
      "<svg x=\"{}\" y=\"{}\" width=\"{:.1f}\" height=\"{:.1f}\" class=\"clip\">\n{}</svg>\n{}"
      "</svg>\n",
      place, size().width, size().height, escape_html(texts.title), kLeft, kTop, width_, height_,
      content, axes(texts.x_label, texts.y_label));
}

}  // namespace qsmpc::harness
