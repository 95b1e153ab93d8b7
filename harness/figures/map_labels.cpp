#include "harness/figures/map_labels.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "harness/text/html.hpp"
#include "harness/text/text_width.hpp"

namespace qsmpc::harness {
namespace {

// View box units.
constexpr double kLabelTextSize = 12.0;
constexpr double kDescent = 2.0;  // of letters below the baseline
constexpr double kNear = 9.0;     // distance of a text from its point
constexpr double kBold = 1.2;     // relative width of bold letters

struct TextBox {
  double left = 0.0;
  double right = 0.0;
  double top = 0.0;
  double bottom = 0.0;
};

/// Area of the intersection of two boxes.
double overlap(const TextBox& a, const TextBox& b) {
  const double across = std::min(a.right, b.right) - std::max(a.left, b.left);
  const double down = std::min(a.bottom, b.bottom) - std::max(a.top, b.top);
  return across > 0.0 && down > 0.0 ? across * down : 0.0;
}

struct TextPlace {
  TextBox box;
  double away = 0.0;  ///< extra distance from its point
};

TextBox box_at(double left, double top, double width) {
  return {.left = left, .right = left + width, .top = top, .bottom = top + kLabelTextSize};
}

/// Candidate places beside `at` for a text of `width`, the best first.
std::vector<TextPlace> places_beside(const MapPoint& at, double width) {
  std::vector<TextPlace> places;
  for (const double away : {kNear, 2.0 * kNear, 4.0 * kNear}) {
    const double below = at.y + away - 4.0;
    const double above = at.y - away + 4.0 - kLabelTextSize;
    const double right = at.x + away;
    const double left = at.x - away - width;
    const double middle = at.x - width / 2.0;
    const double level = at.y - kLabelTextSize / 2.0;
    for (const TextBox& box :
         {box_at(right, below, width), box_at(right, above, width), box_at(left, below, width),
          box_at(left, above, width), box_at(middle, below + 3.0, width),
          box_at(middle, above - 3.0, width), box_at(right, level, width),
          box_at(left, level, width)}) {
      places.push_back({.box = box, .away = away - kNear});
    }
  }
  return places;
}

/// Candidate places around `at`, directly outside the outline.
std::vector<TextPlace> places_outside(const MapCanvas& canvas, const PlacedText& text,
                                      double width) {
  constexpr double kGap = 3.0;
  const MapPoint middle = canvas.place(text.at);
  std::vector<TextPlace> places;
  for (const MapPoint& point : text.outline) {
    const MapPoint on = canvas.place(point);
    const double length = std::max(std::hypot(on.x - middle.x, on.y - middle.y), kNear);
    const double x = (on.x - middle.x) / length;
    const double y = (on.y - middle.y) / length;
    // Distance from the outline to the text's middle: half of the text's extent in this direction,
    // and a gap.
    const double away = std::abs(x) * width / 2.0 + std::abs(y) * kLabelTextSize / 2.0 + kGap;
    places.push_back({.box = box_at(on.x + away * x - width / 2.0,
                                    on.y + away * y - kLabelTextSize / 2.0, width)});
  }
  return places;
}

/// Cost of a place, in units of area.
double cost_of(const TextPlace& place, const TextBox& map, const std::vector<TextBox>& taken,
               const std::vector<MapPoint>& ink) {
  constexpr double kAreaOfInk = 8.0;   // per covered point
  constexpr double kAreaOfAway = 1.0;  // per unit of distance
  constexpr double kOutside = 10.0;    // weight of text that is cut off or overlaps another
  const TextBox& box = place.box;
  double hidden = (box.right - box.left) * (box.bottom - box.top) - overlap(box, map);
  for (const TextBox& other : taken) hidden += overlap(box, other);
  const auto covered = std::count_if(ink.begin(), ink.end(), [&](const MapPoint& point) {
    return point.x > box.left && point.x < box.right && point.y > box.top && point.y < box.bottom;
  });
  return kOutside * hidden + kAreaOfInk * static_cast<double>(covered) + kAreaOfAway * place.away;
}

}  // namespace

std::string texts_svg(const MapCanvas& canvas, const std::vector<PlacedText>& texts,
                      const std::vector<MapPoint>& ink) {
  const TextBox map{.right = canvas.inner_size().width, .bottom = canvas.inner_size().height};
  std::vector<MapPoint> covered;
  covered.reserve(ink.size());
  for (const MapPoint& point : ink) covered.push_back(canvas.place(point));
  std::vector<TextBox> taken;
  std::string grounds;
  std::string svg;
  for (const PlacedText& text : texts) {
    const double width = kBold * estimated_width(text.text, kLabelTextSize);
    const std::vector<TextPlace> places = text.outline.empty()
                                              ? places_beside(canvas.place(text.at), width)
                                              : places_outside(canvas, text, width);
    std::vector<double> costs;
    costs.reserve(places.size());
    for (const TextPlace& place : places) costs.push_back(cost_of(place, map, taken, covered));
    const auto best = std::min_element(costs.begin(), costs.end()) - costs.begin();
    taken.push_back(places[static_cast<std::size_t>(best)].box);
    const std::string rest = fmt::format(" x=\"{:.1f}\" y=\"{:.1f}\">{}</text>", taken.back().left,
                                         taken.back().bottom - kDescent, escape_html(text.text));
    // The text's background is a separate element: not every program supports paint-order.
    grounds += "<text class=\"time edge\" aria-hidden=\"true\"" + rest;
    svg += "<text class=\"time\"" + rest + "\n";
  }
  return grounds.empty() ? "" : grounds + "\n" + svg;
}

}  // namespace qsmpc::harness
