#include "render/hud.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "render/palette.hpp"

namespace qsmpc {
namespace {

// Pixels of a picture of 1280x720.
constexpr double kReferenceWidth = 1280.0;
constexpr double kReferenceHeight = 720.0;
constexpr double kMargin = 16.0;
constexpr double kPadding = 14.0;
constexpr double kPanelWidth = 312.0;
constexpr double kTitleHeight = 34.0;
constexpr double kRowHeight = 22.0;
constexpr double kChartGap = 8.0;
constexpr double kChartTitle = 20.0;
constexpr double kChartHeight = 62.0;
constexpr double kLegendHeight = 34.0;
constexpr double kCorner = 8.0;
constexpr std::size_t kLeastChartSteps = 40;  // a short history does not fill its chart

constexpr Colour kPanel{0.055F, 0.075F, 0.11F, 0.80F};
constexpr Colour kChartGround{0.0F, 0.0F, 0.0F, 0.32F};
constexpr Colour kChartLine{1.0F, 1.0F, 1.0F, 0.14F};
constexpr Colour kText{0.96F, 0.97F, 0.98F};
constexpr Colour kFaintText{0.66F, 0.71F, 0.78F};
// Okabe and Ito's colours, which any colour vision tells apart.
constexpr std::array<Colour, 4> kChartColours{
    {{0.34F, 0.71F, 0.91F}, {0.90F, 0.62F, 0.0F}, {0.40F, 0.80F, 0.65F}, {0.87F, 0.55F, 0.74F}}};

// `text`, cut so that it is at most `width` pixels wide.
std::string fitting(const Font& font, std::string text, double width) {
  if (font.width(text) <= width) {
    return text;
  }
  while (!text.empty() && font.width(text + "..") > width) {
    text.pop_back();
  }
  return text + "..";
}

// Where `value` is between the chart's lower (0) and upper (1) edge; NaN stays NaN.
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

double panel_height(const Frame& frame) {
  return (frame.title.empty() ? 0.0 : kTitleHeight) +
         static_cast<double>(frame.hud.size()) * kRowHeight +
         static_cast<double>(frame.charts.size()) * (kChartGap + kChartTitle + kChartHeight) +
         2.0 * kPadding;
}

bool has_panel(const Frame& frame) {
  return !frame.title.empty() || !frame.hud.empty() || !frame.charts.empty();
}

}  // namespace

Hud::Hud(int width, int height)
    : width_(width),
      height_(height),
      scale_(std::min(width / kReferenceWidth, height / kReferenceHeight)),
      title_font_(17.5 * scale_),
      text_font_(14.0 * scale_),
      small_font_(11.0 * scale_),
      banner_font_(30.0 * scale_) {}

double Hud::covered_share(const Frame& frame) const {
  return has_panel(frame) ? scale_ * (kMargin + kPanelWidth) / width_ : 0.0;
}

void Hud::draw(const Frame& frame, Image& image) const {
  if (has_panel(frame)) {
    draw_panel(frame, image);
    draw_legend(frame, image);
  }
  if (!frame.banner.empty()) {
    draw_banner(frame, image);
  }
}

void Hud::draw_panel(const Frame& frame, Image& image) const {
  const double left = scale_ * kMargin;
  fill_rectangle(image, {left, left, scale_ * kPanelWidth, scale_ * panel_height(frame)}, kPanel,
                 scale_ * kCorner);
  double top = kMargin + kPadding;
  if (!frame.title.empty()) {
    const double inner = scale_ * (kPanelWidth - 2.0 * kPadding);
    draw_text(image, title_font_, fitting(title_font_, frame.title, inner),
              {left + scale_ * kPadding, scale_ * (top + 15.0)}, kText);
    fill_rectangle(image, {left + scale_ * kPadding, scale_ * (top + 25.0), inner, scale_ * 1.0},
                   kChartLine);
    top += kTitleHeight;
  }
  for (const HudRow& row : frame.hud) {
    draw_row(row, scale_ * (top + 15.0), image);
    top += kRowHeight;
  }
  for (std::size_t i = 0; i < frame.charts.size(); ++i) {
    draw_chart(frame.charts[i], top + kChartGap, kChartColours[i % kChartColours.size()], image);
    top += kChartGap + kChartTitle + kChartHeight;
  }
}

void Hud::draw_row(const HudRow& row, double baseline, Image& image) const {
  const double left = scale_ * (kMargin + kPadding);
  const double right = scale_ * (kMargin + kPanelWidth - kPadding);
  const std::string value = fitting(text_font_, row.value, 0.62 * (right - left));
  const double value_left = right - text_font_.width(value);
  const std::string name = fitting(text_font_, row.name, value_left - left - scale_ * 8.0);
  draw_text(image, text_font_, name, {left, baseline}, kFaintText);
  draw_text(image, text_font_, value, {value_left, baseline}, kText);
}

void Hud::draw_chart(const StripChart& chart, double top, const Colour& colour,
                     Image& image) const {
  const double left = scale_ * (kMargin + kPadding);
  const double width = scale_ * (kPanelWidth - 2.0 * kPadding);
  const double ground = scale_ * (top + kChartTitle);
  const double height = scale_ * kChartHeight;
  draw_text(image, small_font_, fitting(small_font_, chart.label, width),
            {left, scale_ * (top + 13.0)}, colour);
  fill_rectangle(image, {left, ground, width, height}, kChartGround, scale_ * 3.0);
  fill_rectangle(image, {left, ground + 0.5 * height, width, scale_ * 1.0}, kChartLine);

  const std::string upper = fmt::format("{:.3g}", chart.upper);
  const std::string lower = fmt::format("{:.3g}", chart.lower);
  const double labels = std::max(small_font_.width(upper), small_font_.width(lower)) + scale_ * 8.0;
  const double label_left = left + width - labels + scale_ * 5.0;
  draw_text(image, small_font_, upper, {label_left, ground + scale_ * 11.0}, kFaintText);
  draw_text(image, small_font_, lower, {label_left, ground + height - scale_ * 4.0}, kFaintText);

  const std::size_t steps = std::max(chart.values.size(), kLeastChartSteps);
  const double inset = scale_ * 3.0;
  const double step = (width - labels - 2.0 * inset) / static_cast<double>(steps - 1);
  std::vector<PixelPoint> points;
  for (std::size_t i = 0; i < chart.values.size(); ++i) {
    const double share = chart_share(chart, chart.values[i]);
    points.push_back({left + inset + static_cast<double>(i) * step,
                      ground + inset + (1.0 - share) * (height - 2.0 * inset)});
  }
  draw_graph(image, points, scale_ * 1.8, colour);
  if (!points.empty() && std::isfinite(points.back().y)) {
    fill_circle(image, points.back(), scale_ * 3.0, colour);
  }
}

void Hud::draw_legend(const Frame& frame, Image& image) const {
  struct Entry {
    std::string text;
    std::vector<Colour> dots;  // one: a line or patch of this colour
  };
  std::vector<Entry> entries;
  const int stages = static_cast<int>(frame.particles.size());
  if (stages > 0) {
    Entry belief{stages > 1 ? fmt::format("belief, stage 0-{}", stages - 1) : "belief", {}};
    for (int stage = 0; stage < stages; ++stage) {
      belief.dots.push_back(stage_colour(stage, stages));
    }
    entries.push_back(std::move(belief));
  }
  if (!frame.planned_path.empty()) {
    entries.push_back({"planned mean", {Colour{1.0F, 1.0F, 1.0F}}});
  }
  if (!frame.driven_path.empty()) {
    entries.push_back({"driven path", {Colour{0.45F, 0.62F, 0.90F}}});
  }
  entries.push_back({"target", {mix(palette::kTarget, {1.0F, 1.0F, 1.0F}, 0.25F)}});

  const auto marks_width = [&](const Entry& entry) {
    return scale_ * (entry.dots.size() > 1 ? 9.0 * static_cast<double>(entry.dots.size()) : 18.0);
  };
  const double gap = scale_ * 7.0;
  const double pause = scale_ * 20.0;
  double width = 2.0 * scale_ * kPadding - pause;
  for (const Entry& entry : entries) {
    width += marks_width(entry) + gap + small_font_.width(entry.text) + pause;
  }
  double x = width_ - scale_ * kMargin - width;
  const double top = height_ - scale_ * (kMargin + kLegendHeight);
  const double middle = top + 0.5 * scale_ * kLegendHeight;
  fill_rectangle(image, {x, top, width, scale_ * kLegendHeight}, kPanel, scale_ * kCorner);
  x += scale_ * kPadding;
  for (const Entry& entry : entries) {
    if (entry.dots.size() > 1) {
      for (std::size_t i = 0; i < entry.dots.size(); ++i) {
        const Colour brighter = mix(entry.dots[i], {1.0F, 1.0F, 1.0F}, 0.12F);
        fill_circle(image, {x + scale_ * (4.5 + 9.0 * static_cast<double>(i)), middle},
                    scale_ * 4.6, brighter);
      }
    } else {
      fill_rectangle(image, {x, middle - scale_ * 1.75, marks_width(entry), scale_ * 3.5},
                     entry.dots[0], scale_ * 1.75);
    }
    x += marks_width(entry) + gap;
    draw_text(image, small_font_, entry.text, {x, middle + scale_ * 4.0}, kText);
    x += small_font_.width(entry.text) + pause;
  }
}

void Hud::draw_banner(const Frame& frame, Image& image) const {
  const double covered = covered_share(frame) * width_;
  const double room = width_ - covered - scale_ * 4.0 * kMargin;
  const std::string text = fitting(banner_font_, frame.banner, room);
  const double width = banner_font_.width(text) + scale_ * 56.0;
  const double left = covered + 0.5 * (width_ - covered - width);
  const double top = scale_ * 64.0;
  fill_rectangle(image, {left, top, width, scale_ * 62.0}, kPanel.with_alpha(0.86F), scale_ * 12.0);
  draw_text(image, banner_font_, text, {left + scale_ * 28.0, top + scale_ * 41.0}, kText);
}

}  // namespace qsmpc
