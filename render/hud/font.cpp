#include "render/hud/font.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string_view>

#include "render/hud/font_table.hpp"

namespace qsmpc {
namespace {

std::size_t glyph_index(char character) {
  const bool printable = character >= kFirstGlyph && character <= kLastGlyph;
  return static_cast<std::size_t>((printable ? character : '?') - kFirstGlyph);
}

int base64_digit(char digit) {
  if (digit >= 'A' && digit <= 'Z') {
    return digit - 'A';
  }
  if (digit >= 'a' && digit <= 'z') {
    return digit - 'a' + 26;
  }
  if (digit >= '0' && digit <= '9') {
    return digit - '0' + 52;
  }
  return digit == '+' ? 62 : 63;
}

bool raster_bit(int position) {
  return ((base64_digit(glyph_bits[position / 6]) >> (5 - position % 6)) & 1) != 0;
}

// Length of the overlap of [a0, a1] and [b0, b1].
double overlap(double a0, double a1, double b0, double b1) {
  return std::max(0.0, std::min(a1, b1) - std::max(a0, b0));
}

// Each pixel of the result is the share of its area that the enlarged or reduced raster covers.
GlyphCoverage scaled_glyph(const GlyphMetrics& metrics, double scale, double shift) {
  const double x0 = metrics.left * scale + shift;
  const double y0 = -metrics.top * scale;
  GlyphCoverage glyph;
  glyph.left = static_cast<int>(std::floor(x0));
  glyph.top = static_cast<int>(std::floor(y0));
  glyph.width = static_cast<int>(std::ceil(x0 + metrics.width * scale)) - glyph.left;
  glyph.height = static_cast<int>(std::ceil(y0 + metrics.height * scale)) - glyph.top;
  glyph.coverage.assign(
      static_cast<std::size_t>(glyph.width) * static_cast<std::size_t>(glyph.height), 0.0F);
  for (int i = 0; i < metrics.width * metrics.height; ++i) {
    if (!raster_bit(metrics.first_bit + i)) {
      continue;
    }
    const double left = x0 + (i % metrics.width) * scale - glyph.left;
    const double top =
        y0 + (i / metrics.width) * scale - glyph.top;  // NOLINT(bugprone-integer-division)
    for (int y = static_cast<int>(top);
         y < std::min(glyph.height, static_cast<int>(top + scale) + 1); ++y) {
      for (int x = static_cast<int>(left);
           x < std::min(glyph.width, static_cast<int>(left + scale) + 1); ++x) {
        const double area =
            overlap(left, left + scale, x, x + 1) * overlap(top, top + scale, y, y + 1);
        glyph.coverage[glyph.index(x, y)] += static_cast<float>(area);
      }
    }
  }
  return glyph;
}

}  // namespace

Font::Font(double size) : size_(size) {
  for (std::size_t i = 0; i < glyphs_.size(); ++i) {
    for (int shift = 0; shift < kShifts; ++shift) {
      glyphs_[i][static_cast<std::size_t>(shift)] =
          scaled_glyph(glyph_metrics[i], size / kFontEm, static_cast<double>(shift) / kShifts);
    }
  }
}

double Font::advance(char character) const {
  return glyph_metrics[glyph_index(character)].advance * size_ / kFontEm;
}

double Font::width(std::string_view text) const {
  double total = 0.0;
  for (const char character : text) {
    total += advance(character);
  }
  return total;
}

const GlyphCoverage& Font::glyph(char character, int shift) const {
  return glyphs_[glyph_index(character)][static_cast<std::size_t>(shift)];
}

}  // namespace qsmpc
