#include "render/hud/strip_chart.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <string>
#include <vector>

#include <fmt/format.h>

namespace qsmpc::render {
namespace {

constexpr double kInset = 3.0;        // pixels between the ground's edge and the curve
constexpr double kDash = 6.0;         // pixels
constexpr double kLeastGround = 2.2;  // letters high

double title_height(const HudStyle& style) { return 1.6 * style.small.size(); }

struct Plot {
  PixelRectangle ground;
  double curve_width;  // pixels; the rest is for the labels of the range
  std::string upper;
  std::string lower;
};

Plot plot_of(const StripChart& chart, const PixelRectangle& area, const HudStyle& style) {
  Plot plot{.ground = {area.x, area.y + title_height(style), area.width,
                       area.height - title_height(style)},
            .curve_width = 0.0,
            .upper = chart.upper_label.empty() ? short_number(chart.upper) : chart.upper_label,
            .lower = chart.lower_label.empty() ? short_number(chart.lower) : chart.lower_label};
  // The same for all charts, so that their time axes align.
  const double labels = style.small.width("10⁻⁶ %");
  plot.curve_width = area.width - labels - 3.0 * kInset;
  return plot;
}

// Position of `value` between the chart's lower (0) and upper (1) edge; NaN stays NaN.
double chart_share(const StripChart& chart, double value) {
  const auto measure = [&chart](double v) {
    constexpr double kLeastPositive = 1e-300;
    return chart.logarithmic ? std::log10(std::max(v, kLeastPositive)) : v;
  };
  if (std::isnan(value)) {
    return value;
  }
  const double lower = measure(chart.lower);
  const double upper = measure(chart.upper);
  return std::clamp((measure(value) - lower) / (upper - lower), 0.0, 1.0);
}

PixelPoint point_in(const Plot& plot, const StripChart& chart, std::size_t slot, double value) {
  const std::size_t slots = std::max({chart.slots, chart.values.size(), std::size_t{2}});
  const double step = (plot.curve_width - 2.0 * kInset) / static_cast<double>(slots - 1);
  const double share = chart_share(chart, value);
  return {plot.ground.x + kInset + static_cast<double>(slot) * step,
          plot.ground.y + kInset + (1.0 - share) * (plot.ground.height - 2.0 * kInset)};
}

void draw_limit(const StripChart& chart, const Plot& plot, const HudStyle& style, Canvas& canvas) {
  const double y = point_in(plot, chart, 0, chart.limit->value).y;
  const double end = plot.ground.x + plot.curve_width;
  const int dashes = static_cast<int>(std::ceil(plot.curve_width / (2.0 * kDash)));
  for (int dash = 0; dash < dashes; ++dash) {
    const double x = plot.ground.x + 2.0 * kDash * dash;
    canvas.fill_rectangle({x, y - 0.5, std::min(kDash, end - x), 1.0}, hud_colour::kLimit);
  }
  // At the end of the time axis, which the curve reaches last, and on its own background.
  const double letters = style.small.size();
  const double width = style.small.width(chart.limit->label) + 2.0 * kInset;
  const bool above = y - 1.2 * letters > plot.ground.y;
  const double top = above ? y - 1.2 * letters - 1.0 : y + 2.0;
  canvas.fill_rectangle({end - width, top, width, 1.2 * letters},
                        hud_colour::kBand.with_alpha(0.7F));
  canvas.draw_text(style.small, chart.limit->label, {end - width + kInset, top + letters},
                   hud_colour::kLimit);
}

std::string superscript(int exponent) {
  constexpr std::array<const char*, 10> kDigits{"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
  std::string raised = exponent < 0 ? "⁻" : "";
  for (const char digit : std::to_string(std::abs(exponent))) {
    raised += kDigits[static_cast<std::size_t>(digit - '0')];
  }
  return raised;
}

}  // namespace

std::string short_number(double value) {
  constexpr double kLeastPlain = 1e-3;
  constexpr double kLargestPlain = 1e5;
  const double size = std::abs(value);
  if (!std::isfinite(value)) return std::isnan(value) ? "–" : value < 0.0 ? "−∞" : "∞";
  if (size == 0.0) return "0";
  const std::string sign = value < 0.0 ? "−" : "";
  if (size >= kLeastPlain * (1.0 - 1e-9) && size < 0.9995 * kLargestPlain) {
    // Format {:.3g} would give whole numbers an exponent.
    return sign + (size >= 999.5 ? fmt::format("{:.0f}", size) : fmt::format("{:.3g}", size));
  }
  const std::string digits = fmt::format("{:.1e}", size);
  const std::size_t end = digits.find('e');
  const std::string power = "10" + superscript(std::stoi(digits.substr(end + 1)));
  std::string mantissa = digits.substr(0, end);
  if (mantissa.ends_with(".0")) mantissa.resize(mantissa.size() - 2);
  return sign + (mantissa == "1" ? power : mantissa + " × " + power);
}

double least_chart_height(const HudStyle& style) {
  return title_height(style) + kLeastGround * style.small.size();
}

PixelPoint chart_point(const StripChart& chart, const PixelRectangle& area, const HudStyle& style,
                       std::size_t slot, double value) {
  return point_in(plot_of(chart, area, style), chart, slot, value);
}

void draw_strip_chart(const StripChart& chart, const PixelRectangle& area, const Colour& colour,
                      const HudStyle& style, Canvas& canvas) {
  const Plot plot = plot_of(chart, area, style);
  const PixelRectangle& ground = plot.ground;
  const double baseline = area.y + 1.1 * style.small.size();
  const std::string value = fitting(style.small, chart.value, 0.6 * area.width);
  const double value_left = area.x + area.width - style.small.width(value);
  canvas.draw_text(style.small,
                   fitting(style.small, chart.label, value_left - area.x - style.gap()),
                   {area.x, baseline}, colour);
  canvas.draw_text(style.small, value, {value_left, baseline}, hud_colour::kText);
  canvas.fill_rectangle(ground, hud_colour::kChartGround, kInset);
  canvas.fill_rectangle({ground.x, ground.y + 0.5 * ground.height, plot.curve_width, 1.0},
                        hud_colour::kChartLine);
  const double right = ground.x + ground.width - kInset;
  canvas.draw_text(style.small, plot.upper,
                   {right - style.small.width(plot.upper), ground.y + style.small.size()},
                   hud_colour::kFaintText);
  canvas.draw_text(style.small, plot.lower,
                   {right - style.small.width(plot.lower), ground.y + ground.height - kInset},
                   hud_colour::kFaintText);
  std::vector<PixelPoint> points;
  for (std::size_t i = 0; i < chart.values.size(); ++i) {
    points.push_back(point_in(plot, chart, i, chart.values[i]));
  }
  canvas.draw_graph(points, std::max(1.8 * style.scale, 1.2), colour);
  if (!points.empty() && std::isfinite(points.back().y)) {
    canvas.fill_circle(points.back(), std::max(3.0 * style.scale, 2.0), colour);
  }
  if (chart.limit) {
    draw_limit(chart, plot, style, canvas);
  }
}

}  // namespace qsmpc::render
