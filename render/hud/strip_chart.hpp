// One strip chart of the head-up display.
#pragma once

#include <string>

#include "render/frame.hpp"
#include "render/hud/canvas.hpp"
#include "render/hud/hud_style.hpp"

namespace qsmpc::render {

/// `value` in at most three digits, e.g. "−0.785", "0", "1200"; from 10⁵ on and below 10⁻³ as a
/// power of ten, e.g. "10⁵", "3.5 × 10⁻⁶". Never "-0".
[[nodiscard]] std::string short_number(double value);

/// Pixels, the least height at which a chart with its title can be read.
[[nodiscard]] double least_chart_height(const HudStyle& style);

/// Draws `chart` into `area`: its label and newest value above, the history below, and its limit,
/// if it has one, as a dashed line with its label.
void draw_strip_chart(const StripChart& chart, const PixelRectangle& area, const Colour& colour,
                      const HudStyle& style, Canvas& canvas);

/// Where value `value` is drawn in the chart's slot `slot`; beyond the chart's range at its edge.
[[nodiscard]] PixelPoint chart_point(const StripChart& chart, const PixelRectangle& area,
                                     const HudStyle& style, std::size_t slot, double value);

}  // namespace qsmpc::render
