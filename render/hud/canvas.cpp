#include "render/hud/canvas.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace qsmpc {
namespace {

unsigned char blended(unsigned char below, float above, float share) {
  const float value =
      static_cast<float>(below) + share * (255.0F * above - static_cast<float>(below));
  // NOLINTNEXTLINE(bugprone-incorrect-roundings): it is not negative.
  return static_cast<unsigned char>(value + 0.5F);
}

// `x` and `y` lie in the image.
void blend_pixel(Image& image, int x, int y, const Colour& colour, float coverage) {
  const float share = colour.alpha * coverage;
  unsigned char* const pixel = &image.rgb[3 * (static_cast<std::size_t>(y) * image.width + x)];
  pixel[0] = blended(pixel[0], colour.red, share);
  pixel[1] = blended(pixel[1], colour.green, share);
  pixel[2] = blended(pixel[2], colour.blue, share);
}

struct PixelRange {
  int begin;
  int end;
};

PixelRange clipped(double begin, double end, int size) {
  const double limit = size;
  return {static_cast<int>(std::clamp(std::floor(begin), 0.0, limit)),
          static_cast<int>(std::clamp(std::ceil(end), 0.0, limit))};
}

// Blends every pixel of `area` by the share of it that lies within the outline, whose signed
// distance from a pixel's centre (positive outside) `distance` tells.
template <typename Distance>
void fill_outline(Image& image, const PixelRectangle& area, const Colour& colour,
                  const Distance& distance) {
  const PixelRange columns = clipped(area.x, area.x + area.width, image.width);
  const PixelRange rows = clipped(area.y, area.y + area.height, image.height);
  for (int y = rows.begin; y < rows.end; ++y) {
    for (int x = columns.begin; x < columns.end; ++x) {
      const double coverage = std::clamp(0.5 - distance(x + 0.5, y + 0.5), 0.0, 1.0);
      if (coverage > 0.0) {
        blend_pixel(image, x, y, colour, static_cast<float>(coverage));
      }
    }
  }
}

// Height range of the line within a column of one pixel; empty where it has none.
struct ColumnSpan {
  double top = std::numeric_limits<double>::infinity();
  double bottom = -std::numeric_limits<double>::infinity();
};

void widen_spans(const PixelPoint& from, const PixelPoint& to, std::vector<ColumnSpan>& spans) {
  const int last = static_cast<int>(spans.size()) - 1;
  const int begin = std::clamp(static_cast<int>(std::floor(from.x)), 0, last);
  const int end = std::clamp(static_cast<int>(std::floor(to.x)), 0, last);
  for (int column = begin; column <= end; ++column) {
    for (const double edge : {static_cast<double>(column), column + 1.0}) {
      const double share =
          to.x > from.x ? std::clamp((edge - from.x) / (to.x - from.x), 0.0, 1.0) : 0.0;
      const double y = from.y + share * (to.y - from.y);
      ColumnSpan& span = spans[static_cast<std::size_t>(column)];
      span.top = std::min(span.top, y);
      span.bottom = std::max(span.bottom, y);
    }
  }
}

}  // namespace

void fill_rectangle(Image& image, const PixelRectangle& area, const Colour& colour, double radius) {
  const double centre_x = area.x + 0.5 * area.width;
  const double centre_y = area.y + 0.5 * area.height;
  fill_outline(image, area, colour, [&](double x, double y) {
    const double dx = std::abs(x - centre_x) - 0.5 * area.width + radius;
    const double dy = std::abs(y - centre_y) - 0.5 * area.height + radius;
    const bool at_corner = dx > 0.0 && dy > 0.0;
    return (at_corner ? std::sqrt(dx * dx + dy * dy) : std::max(dx, dy)) - radius;
  });
}

void fill_circle(Image& image, const PixelPoint& centre, double radius, const Colour& colour) {
  const double side = 2.0 * (radius + 1.0);
  fill_outline(image, {centre.x - 0.5 * side, centre.y - 0.5 * side, side, side}, colour,
               [&](double x, double y) { return std::hypot(x - centre.x, y - centre.y) - radius; });
}

void draw_graph(Image& image, const std::vector<PixelPoint>& points, double width,
                const Colour& colour) {
  if (image.width == 0) {
    return;
  }
  std::vector<ColumnSpan> spans(static_cast<std::size_t>(image.width));
  const auto finite = [](const PixelPoint& p) { return std::isfinite(p.x) && std::isfinite(p.y); };
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    if (finite(points[i]) && finite(points[i + 1])) {
      widen_spans(points[i], points[i + 1], spans);
    }
  }
  for (int x = 0; x < image.width; ++x) {
    const ColumnSpan& span = spans[static_cast<std::size_t>(x)];
    if (span.top > span.bottom) {
      continue;
    }
    const double top = span.top - 0.5 * width;
    const double bottom = span.bottom + 0.5 * width;
    const PixelRange rows = clipped(top, bottom, image.height);
    for (int y = rows.begin; y < rows.end; ++y) {
      const double coverage = std::min(bottom, y + 1.0) - std::max(top, static_cast<double>(y));
      blend_pixel(image, x, y, colour, static_cast<float>(std::clamp(coverage, 0.0, 1.0)));
    }
  }
}

void draw_text(Image& image, const Font& font, std::string_view text, const PixelPoint& pen,
               const Colour& colour) {
  const int baseline = static_cast<int>(std::lround(pen.y));
  double position = pen.x;
  for (const char character : text) {
    // Rounded to quarters of a pixel: letters keep their distances without a raster for each.
    const auto quarters = static_cast<int>(std::floor(position * Font::kShifts));
    const int shift = ((quarters % Font::kShifts) + Font::kShifts) % Font::kShifts;
    const GlyphCoverage& glyph = font.glyph(character, shift);
    const int left = (quarters - shift) / Font::kShifts + glyph.left;
    for (int row = 0; row < glyph.height; ++row) {
      for (int column = 0; column < glyph.width; ++column) {
        const int x = left + column;
        const int y = baseline + glyph.top + row;
        const float coverage = glyph.coverage[glyph.index(column, row)];
        if (coverage > 0.0F && x >= 0 && x < image.width && y >= 0 && y < image.height) {
          blend_pixel(image, x, y, colour, std::min(coverage, 1.0F));
        }
      }
    }
    position += font.advance(character);
  }
}

}  // namespace qsmpc
