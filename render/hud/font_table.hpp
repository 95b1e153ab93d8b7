// The glyphs of the head-up display as data, so that a picture looks the same on every machine.
#pragma once

#include <array>

namespace qsmpc {

/// One glyph, in pixels of a raster of `kFontEm` pixels per em, y upwards from the baseline.
struct GlyphMetrics {
  int advance;    ///< from this glyph's origin to the next one's
  int left;       ///< from the origin to the raster's first column
  int top;        ///< from the baseline up to the upper edge of the raster's first row
  int width;      ///< columns of the raster
  int height;     ///< rows of the raster
  int first_bit;  ///< where its raster begins in `glyph_bits`
};

constexpr int kFontEm = 64;  ///< pixels
constexpr char kFirstGlyph = ' ';
constexpr char kLastGlyph = '~';

/// Printable ASCII, from kFirstGlyph to kLastGlyph.
extern const std::array<GlyphMetrics, 95> glyph_metrics;

/// All rasters, one bit a pixel, row by row from the top, six bits a base64 digit.
extern const char* const glyph_bits;

}  // namespace qsmpc
