#include "render/hud/hud.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>

#include "render/hud/legend.hpp"
#include "render/hud/strip_chart.hpp"

namespace qsmpc::render {
namespace {

// Pixels of a picture of 1280x720.
constexpr double kColumnWidth = 228.0;
constexpr double kLeastChart = 72.0;
constexpr double kMostChart = 112.0;
constexpr double kBandHeight = 158.0;
constexpr double kBandRows = 240.0;
constexpr double kBandChart = 150.0;

constexpr double kLeastColumn = 14.5;     // letters wide
constexpr double kLeastBandChart = 11.0;  // letters wide
constexpr double kKeptAbout = 1.5;        // letters of the banner, clear about points to keep
constexpr float kBannerOpacity = 0.86F;

const Colour& chart_colour(std::size_t index) {
  return hud_colour::kCharts[index % hud_colour::kCharts.size()];
}

}  // namespace

Hud::Hud(int width, int height) : style_(width, height) {}

double Hud::column_width() const {
  return std::round(std::max(kColumnWidth * style_.scale, kLeastColumn * style_.text.size()));
}

double Hud::band_height() const {
  const double rows = style_.title_height() + 3.0 * style_.row_height() + 2.0 * style_.padding();
  return std::round(std::max(kBandHeight * style_.scale, rows));
}

double Hud::legend_height(std::size_t lines) const {
  return std::round(static_cast<double>(lines) * style_.row_height() + style_.gap());
}

double Hud::heading_height() const { return std::round(style_.row_height() + style_.gap()); }

void Hud::draw_column(const Frame& frame, const PixelRectangle& area, Image& image) const {
  Canvas canvas(image, area);
  canvas.fill_rectangle(area, hud_colour::kBand);
  const double padding = 0.8 * style_.padding();
  const PixelRectangle inner{area.x + padding, area.y + padding, area.width - 2.0 * padding,
                             area.height - 2.0 * padding};
  double top = inner.y + draw_rows(frame, inner, canvas);
  const double room = inner.y + inner.height - top;
  const double least = std::max(kLeastChart * style_.scale, least_chart_height(style_));
  const auto fit = static_cast<std::size_t>(std::max(room / (least + style_.gap()), 0.0));
  const std::size_t charts = std::min(frame.charts.size(), fit);
  if (charts == 0) return;
  const double height = std::min(room / static_cast<double>(charts) - style_.gap(),
                                 std::max(kMostChart * style_.scale, least));
  for (std::size_t i = 0; i < charts; ++i) {
    draw_strip_chart(frame.charts[i], {inner.x, top + style_.gap(), inner.width, height},
                     chart_colour(i), style_, canvas);
    top += height + style_.gap();
  }
}

void Hud::draw_line(const Frame& frame, const PixelRectangle& area, Image& image) const {
  std::string line = frame.title;
  for (const HudRow& row : frame.hud) line += "  " + row.name + " " + row.value;
  draw_heading(line, area, image);
}

double Hud::draw_rows(const Frame& frame, const PixelRectangle& area, Canvas& canvas) const {
  double used = 0.0;
  if (!frame.title.empty()) {
    canvas.draw_text(style_.title, fitting(style_.title, frame.title, area.width),
                     {area.x, area.y + 0.86 * style_.title.size()}, hud_colour::kText);
    used = style_.title_height();
    canvas.fill_rectangle({area.x, area.y + 0.73 * used, area.width, 1.0}, hud_colour::kChartLine);
  }
  for (const HudRow& row : frame.hud) {
    if (used + style_.row_height() > area.height + 1.0) break;
    draw_row(row, {area.x, area.y + used, area.width, style_.row_height()}, canvas);
    used += style_.row_height();
  }
  return used;
}

void Hud::draw_row(const HudRow& row, const PixelRectangle& area, Canvas& canvas) const {
  const double baseline = area.y + 1.07 * style_.text.size();
  const std::string value = fitting(style_.text, row.value, 0.62 * area.width);
  const double value_left = area.x + area.width - style_.text.width(value);
  const std::string name = fitting(style_.text, row.name, value_left - area.x - style_.gap());
  canvas.draw_text(style_.text, name, {area.x, baseline},
                   row.warning ? hud_colour::kWarning : hud_colour::kFaintText);
  canvas.draw_text(style_.text, value, {value_left, baseline},
                   row.warning ? hud_colour::kWarning : hud_colour::kText);
}

void Hud::draw_band(const Frame& frame, const PixelRectangle& area, Image& image) const {
  Canvas canvas(image, area);
  canvas.fill_rectangle(area, hud_colour::kBand);
  const double padding = style_.padding();
  const PixelRectangle inner{area.x + padding, area.y + 0.7 * padding, area.width - 2.0 * padding,
                             area.height - padding};
  const double rows =
      std::min(std::max(kBandRows * style_.scale, 15.0 * style_.text.size()), 0.5 * inner.width);
  draw_rows(frame, {inner.x, inner.y, rows, inner.height}, canvas);
  const double gap = 1.6 * style_.gap();
  const double left = inner.x + rows + gap;
  const double width = inner.x + inner.width - left;
  const double least = std::max(kBandChart * style_.scale, kLeastBandChart * style_.small.size());
  const auto count = std::max(static_cast<double>(frame.charts.size()), 1.0);
  const double columns = std::clamp(std::floor((width + gap) / (least + gap)), 1.0, count);
  const double most_lines =
      std::floor((inner.height + style_.gap()) / (least_chart_height(style_) + style_.gap()));
  const double lines = std::min(std::ceil(count / columns), std::max(most_lines, 1.0));
  const double wide = (width - (columns - 1.0) * gap) / columns;
  const double high = (inner.height - (lines - 1.0) * style_.gap()) / lines;
  for (std::size_t i = 0; i < frame.charts.size(); ++i) {
    const double line = std::floor(static_cast<double>(i) / columns);
    if (line >= lines) break;
    const double column = static_cast<double>(i) - line * columns;
    draw_strip_chart(
        frame.charts[i],
        {left + column * (wide + gap), inner.y + line * (high + style_.gap()), wide, high},
        chart_colour(i), style_, canvas);
  }
}

void Hud::draw_legend_band(const Frame& frame, const PixelRectangle& area, Image& image) const {
  Canvas canvas(image, area);
  canvas.fill_rectangle(area, hud_colour::kBand);
  const auto lines = static_cast<std::size_t>(area.height / style_.row_height());
  const Legend legend(frame, style_, area.width - 2.0 * style_.padding(), lines);
  legend.draw({area.x + style_.padding(), area.y + 0.5 * (area.height - legend.height())}, canvas);
}

void Hud::draw_banner(const Frame& frame, const PixelRectangle& area,
                      const std::vector<PixelPoint>& kept, Image& image) const {
  if (frame.banner.empty()) return;
  const double inset = style_.banner.size();
  const double room = area.width - 2.0 * style_.margin() - 2.0 * inset;
  const std::string text = fitting(style_.banner, frame.banner, room);
  const double width = style_.banner.width(text) + 2.0 * inset;
  const double left = area.x + 0.5 * (area.width - width);
  const double height = 2.07 * style_.banner.size();
  const double edge = std::max(48.0 * style_.scale, 12.0);
  const double high = area.y + edge;
  const double low = area.y + area.height - edge - height;
  const auto covered = [&](double at) {
    const double about = kKeptAbout * style_.banner.size();
    return std::count_if(kept.begin(), kept.end(), [&](const PixelPoint& place) {
      return place.x > left - about && place.x < left + width + about && place.y > at - about &&
             place.y < at + height + about;
    });
  };
  const double top = covered(low) < covered(high) ? low : high;
  const PixelRectangle panel{left, top, width, height};
  Canvas canvas(image, panel);
  const Colour ground =
      frame.alarm ? hud_colour::kAlarm : hud_colour::kPanel.with_alpha(kBannerOpacity);
  canvas.fill_rectangle(panel, ground, 12.0 * style_.scale);
  canvas.draw_text(style_.banner, text, {left + inset, top + 1.37 * style_.banner.size()},
                   hud_colour::kText);
}

void Hud::draw_heading(const std::string& text, const PixelRectangle& area, Image& image) const {
  const double padding = style_.padding();
  const std::string line = fitting(style_.text, text, area.width - 2.0 * padding);
  const double height = std::min(heading_height(), area.height);
  const PixelRectangle panel{area.x, area.y, area.width, height};
  Canvas canvas(image, panel);
  canvas.fill_rectangle(panel, hud_colour::kPanel);
  canvas.draw_text(style_.text, line, {area.x + padding, area.y + 0.68 * height},
                   hud_colour::kText);
}

}  // namespace qsmpc::render
