// One strip chart of the head-up display.
#pragma once

#include <string>

#include "render/frame.hpp"
#include "render/hud/canvas.hpp"
#include "render/hud/hud_style.hpp"

namespace qsmpc::render {

/// `value` with at most three significant digits, e.g. "−0.785", "0", or as a whole number from
/// 1000 on, e.g. "1200"; from 10⁵ on and below 10⁻³ with a power of ten, e.g. "10⁵", "3.5 × 10⁻⁶".
/// Never "-0".
[[nodiscard]] std::string short_number(double value);

/// The least height at which a chart with its title is readable, pixels.
[[nodiscard]] double least_chart_height(const HudStyle& style);

/// Draws `chart` into `area`: its label and newest value above, the history below, and its limit,
/// if it has one, as a dashed line with its label.
void draw_strip_chart(const StripChart& chart, const PixelRectangle& area, const Colour& colour,
                      const HudStyle& style, Canvas& canvas);

/// Where `value` is drawn in the chart's slot `slot`; values outside the chart's range are drawn at
/// its edge.
[[nodiscard]] PixelPoint chart_point(const StripChart& chart, const PixelRectangle& area,
                                     const HudStyle& style, std::size_t slot, double value);

}  // namespace qsmpc::render
