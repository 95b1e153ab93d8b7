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
constexpr double kPanelWidth = 312.0;
constexpr double kChartHeight = 80.0;
constexpr double kCorner = 8.0;
constexpr double kBandHeight = 158.0;
constexpr double kBandRows = 240.0;
constexpr double kBandChart = 150.0;

constexpr double kLeastPanel = 19.0;       // letters wide
constexpr double kLeastBandChart = 11.0;   // letters wide
constexpr double kMostCovered = 0.42;      // of the width, by a panel
constexpr double kMostLegendShare = 0.12;  // of the height
constexpr float kBannerOpacity = 0.86F;

bool has_panel(const Frame& frame) {
  return !frame.title.empty() || !frame.hud.empty() || !frame.charts.empty();
}

const Colour& chart_colour(std::size_t index) {
  return hud_colour::kCharts[index % hud_colour::kCharts.size()];
}

}  // namespace

Hud::Hud(int width, int height) : width_(width), height_(height), style_(width, height) {}

double Hud::panel_width() const {
  return std::max(kPanelWidth * style_.scale, kLeastPanel * style_.text.size());
}

double Hud::covered_share(const Frame& frame) const {
  const double share = (style_.margin() + panel_width()) / width_;
  return has_panel(frame) && share <= kMostCovered ? share : 0.0;
}

double Hud::band_height() const {
  const double rows = style_.title_height() + 3.0 * style_.row_height() + 2.0 * style_.padding();
  return std::round(std::max(kBandHeight * style_.scale, rows));
}

double Hud::legend_height(std::size_t lines) const {
  return std::round(static_cast<double>(lines) * style_.row_height() + style_.gap());
}

void Hud::draw(const Frame& frame, Image& image) const {
  const double covered = covered_share(frame) * width_;
  if (covered > 0.0) {
    draw_panel(frame, image);
    draw_legend(frame, image);
  } else if (has_panel(frame)) {
    std::string line = frame.title;
    for (const HudRow& row : frame.hud) line += "  " + row.name + " " + row.value;
    draw_heading(line, {0.0, 0.0, static_cast<double>(width_), static_cast<double>(height_)},
                 image);
  }
  draw_banner(frame, {covered, 0.0, width_ - covered, static_cast<double>(height_)}, image);
}

void Hud::draw_panel(const Frame& frame, Image& image) const {
  const double padding = style_.padding();
  const double left = style_.margin();
  const double room = height_ - 2.0 * left;
  const double rows = (frame.title.empty() ? 0.0 : style_.title_height()) +
                      static_cast<double>(frame.hud.size()) * style_.row_height();
  const double chart =
      std::max(kChartHeight * style_.scale, least_chart_height(style_)) + style_.gap();
  const double fit = std::max(std::floor((room - rows - 2.0 * padding) / chart), 0.0);
  const std::size_t charts = std::min(frame.charts.size(), static_cast<std::size_t>(fit));
  const double height = std::min(rows + static_cast<double>(charts) * chart + 2.0 * padding, room);
  const PixelRectangle panel{left, left, panel_width(), height};
  Canvas canvas(image, panel);
  canvas.fill_rectangle(panel, hud_colour::kPanel, kCorner * style_.scale);
  const PixelRectangle inner{left + padding, left + padding, panel_width() - 2.0 * padding,
                             height - 2.0 * padding};
  double top = inner.y + draw_rows(frame, inner, canvas);
  for (std::size_t i = 0; i < charts; ++i) {
    draw_strip_chart(frame.charts[i],
                     {inner.x, top + style_.gap(), inner.width, chart - style_.gap()},
                     chart_colour(i), style_, canvas);
    top += chart;
  }
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

void Hud::draw_legend(const Frame& frame, Image& image) const {
  const double covered = covered_share(frame) * width_;
  const double margin = style_.margin();
  const double padding = style_.padding();
  const double most = std::floor(kMostLegendShare * height_ / style_.row_height());
  const Legend legend(frame, style_, width_ - covered - 2.0 * margin - 2.0 * padding,
                      std::max(static_cast<std::size_t>(most), std::size_t{1}));
  const double width = legend.width() + 2.0 * padding;
  const double height = legend.height() + style_.gap();
  const double left = width_ - margin - width;
  const double top = height_ - margin - height;
  const PixelRectangle panel{left, top, width, height};
  Canvas canvas(image, panel);
  canvas.fill_rectangle(panel, hud_colour::kPanel, kCorner * style_.scale);
  legend.draw({left + padding, top + 0.5 * style_.gap()}, canvas);
}

void Hud::draw_legend_band(const Frame& frame, const PixelRectangle& area, Image& image) const {
  Canvas canvas(image, area);
  canvas.fill_rectangle(area, hud_colour::kBand);
  const auto lines = static_cast<std::size_t>(area.height / style_.row_height());
  const Legend legend(frame, style_, area.width - 2.0 * style_.padding(), lines);
  legend.draw({area.x + style_.padding(), area.y + 0.5 * (area.height - legend.height())}, canvas);
}

void Hud::draw_banner(const Frame& frame, const PixelRectangle& area, Image& image) const {
  if (frame.banner.empty()) return;
  const double inset = style_.banner.size();
  const double room = area.width - 2.0 * style_.margin() - 2.0 * inset;
  const std::string text = fitting(style_.banner, frame.banner, room);
  const double width = style_.banner.width(text) + 2.0 * inset;
  const double left = area.x + 0.5 * (area.width - width);
  const double top = area.y + std::max(64.0 * style_.scale, 24.0);
  const PixelRectangle panel{left, top, width, 2.07 * style_.banner.size()};
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
  const double height = style_.row_height() + style_.gap();
  const PixelRectangle panel{area.x, area.y, area.width, height};
  Canvas canvas(image, panel);
  canvas.fill_rectangle(panel, hud_colour::kPanel);
  canvas.draw_text(style_.text, line, {area.x + padding, area.y + 0.68 * height},
                   hud_colour::kText);
}

}  // namespace qsmpc::render
