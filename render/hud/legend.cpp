#include "render/hud/legend.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "render/hud/strip_chart.hpp"
#include "render/palette.hpp"

namespace qsmpc::render {
namespace {

constexpr int kRampSteps = 24;
constexpr Colour kWhite{1.0F, 1.0F, 1.0F};

// The tube's colour as it appears on the ground.
Colour tube_colour(double share) {
  const double probability = std::pow(10.0, std::log10(kLeastRisk) * (1.0 - share));
  return mix(palette::kSafeGround, risk_colour(probability), 0.5F * (1.0F + palette::kTubeOpacity));
}

template <typename ColourAt>
std::vector<Colour> ramp(const ColourAt& colour_at) {
  std::vector<Colour> colours;
  colours.reserve(kRampSteps);
  for (int i = 0; i < kRampSteps; ++i) {
    colours.push_back(colour_at(static_cast<double>(i) / (kRampSteps - 1)));
  }
  return colours;
}

}  // namespace

std::vector<Legend::Entry> Legend::entries_of(const Frame& frame) {
  using Mark = Entry::Mark;
  std::vector<Entry> entries;
  const int stages = static_cast<int>(std::max(frame.particles.size(), frame.ellipses.size()));
  if (stages > 0) {
    Entry belief{stages > 1 ? fmt::format("belief, now to stage {}", stages - 1) : "belief",
                 Mark::kDots,
                 {}};
    for (int stage = 0; stage < stages; ++stage) {
      belief.colours.push_back(mix(stage_colour(stage, stages), kWhite, 0.12F));
    }
    entries.push_back(std::move(belief));
  }
  if (!frame.ellipses.empty()) {
    entries.push_back(
        {"its 50 % and 95 % regions", Mark::kRing, {mix(stage_colour(1, 3), kWhite, 0.3F)}});
  }
  if (!frame.raw_points.empty()) {
    entries.push_back({"before compression", Mark::kDots,
                       std::vector<Colour>(3, mix(palette::kRawPoint, kWhite, 0.25F))});
  }
  if (!frame.tube.empty()) {
    entries.push_back({fmt::format("risk at most {} % to 100 %", short_number(100.0 * kLeastRisk)),
                       Mark::kRamp, ramp(tube_colour)});
  }
  if (!frame.planned_path.empty()) {
    entries.push_back({"planned path", Mark::kLine, {kWhite}});
  }
  if (!frame.body.empty()) {
    entries.push_back({"body", Mark::kLine, {palette::kBody}});
  }
  if (frame.ghost) {
    entries.push_back({"predicted before", Mark::kPatch, {palette::kGhost.with_alpha(1.0F)}});
  }
  if (!frame.clearances.empty()) {
    entries.push_back(
        {fmt::format("driven, clearance 0 to {:g} m", kCalmClearance), Mark::kRamp,
         ramp([](double share) { return clearance_colour(share * kCalmClearance); })});
  } else if (!frame.driven_path.empty()) {
    entries.push_back({"driven path", Mark::kLine, {Colour{0.45F, 0.62F, 0.90F}}});
  }
  if (!frame.moving.empty()) {
    entries.push_back(
        {"moving obstacle", Mark::kPatch, {mix(palette::kMovingObstacle, kWhite, 0.15F)}});
  }
  if (!frame.forecasts.empty()) {
    entries.push_back({"its forecast", Mark::kRing, {mix(palette::kForecast, kWhite, 0.35F)}});
  }
  entries.push_back({"unsafe", Mark::kPatch, {mix(palette::kUnsafeEdge, kWhite, 0.15F)}});
  entries.push_back({"target", Mark::kPatch, {mix(palette::kTarget, kWhite, 0.25F)}});
  return entries;
}

Legend::Legend(const Frame& frame, const HudStyle& style, double width, std::size_t most_lines)
    : style_(style) {
  const double pause = std::max(20.0 * style.scale, 10.0);
  double x = 0.0;
  for (Entry& entry : entries_of(frame)) {
    const double wide = mark_width(entry) + style.gap() + style.small.width(entry.text);
    if (x > 0.0 && x + wide > width) {
      x = 0.0;
      ++lines_;
    }
    if (lines_ >= most_lines) break;
    entry.x = x;
    entry.line = lines_;
    width_ = std::max(width_, x + wide);
    x += wide + pause;
    entries_.push_back(std::move(entry));
  }
  lines_ = entries_.empty() ? 0 : entries_.back().line + 1;
}

double Legend::height() const { return static_cast<double>(lines_) * style_.row_height(); }

double Legend::mark_width(const Entry& entry) const {
  const double unit = style_.small.size() / 12.0;
  switch (entry.mark) {
    case Entry::Mark::kDots:
      return unit * std::max(18.0, 8.0 * static_cast<double>(entry.colours.size()));
    case Entry::Mark::kRamp:
      return unit * 60.0;
    default:
      return unit * 18.0;
  }
}

void Legend::draw_mark(const Entry& entry, double x, double middle, Canvas& canvas) const {
  const double unit = style_.small.size() / 12.0;
  const double width = mark_width(entry);
  const auto count = static_cast<double>(entry.colours.size());
  switch (entry.mark) {
    case Entry::Mark::kDots:
      for (std::size_t i = 0; i < entry.colours.size(); ++i) {
        canvas.fill_circle({x + unit * 4.5 + static_cast<double>(i) * unit * 8.0, middle},
                           unit * 4.2, entry.colours[i]);
      }
      break;
    case Entry::Mark::kRamp:
      for (std::size_t i = 0; i < entry.colours.size(); ++i) {
        const double left = std::round(x + width * static_cast<double>(i) / count);
        const double right = std::round(x + width * static_cast<double>(i + 1) / count);
        canvas.fill_rectangle({left, std::round(middle - unit * 4.0), right - left, unit * 8.0},
                              entry.colours[i]);
      }
      break;
    case Entry::Mark::kRing:
      canvas.fill_circle({x + 0.5 * width, middle}, unit * 6.0, entry.colours[0]);
      canvas.fill_circle({x + 0.5 * width, middle}, unit * 4.6, hud_colour::kBand);
      canvas.fill_circle({x + 0.5 * width, middle}, unit * 3.2, entry.colours[0]);
      canvas.fill_circle({x + 0.5 * width, middle}, unit * 1.8, hud_colour::kBand);
      break;
    case Entry::Mark::kLine:
    case Entry::Mark::kPatch: {
      const double half = unit * (entry.mark == Entry::Mark::kLine ? 1.75 : 4.0);
      canvas.fill_rectangle({x, middle - half, width, 2.0 * half}, entry.colours[0], 1.75);
      break;
    }
  }
}

void Legend::draw(const PixelPoint& corner, Canvas& canvas) const {
  for (const Entry& entry : entries_) {
    const double x = corner.x + entry.x;
    const double middle = corner.y + (static_cast<double>(entry.line) + 0.5) * style_.row_height();
    draw_mark(entry, x, middle, canvas);
    canvas.draw_text(style_.small, entry.text,
                     {x + mark_width(entry) + style_.gap(), middle + 0.35 * style_.small.size()},
                     hud_colour::kText);
  }
}

}  // namespace qsmpc::render
