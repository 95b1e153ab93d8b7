// Anti-aliased text on the CPU, at any size, from the rasters in font_table.hpp.
#pragma once

#include <array>
#include <cstddef>
#include <string_view>
#include <vector>

namespace qsmpc {

/// Coverage of one glyph, at one size and one shift of a quarter of a pixel.
struct GlyphCoverage {
  int left = 0;  ///< pixels from the pen's whole pixel to the first column
  int top = 0;   ///< pixels from the baseline down to the first row, usually negative
  int width = 0;
  int height = 0;
  std::vector<float> coverage;  ///< width x height, row by row from the top, in [0, 1]

  /// Where the pixel in `column` and `row` is in `coverage`.
  [[nodiscard]] std::size_t index(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(width) +
           static_cast<std::size_t>(column);
  }
};

class Font {
 public:
  static constexpr int kShifts = 4;  ///< horizontal positions within a pixel

  /// `size`: pixels per em, > 0.
  explicit Font(double size);

  [[nodiscard]] double size() const { return size_; }

  /// Pixels from one glyph's origin to the next one's. What is not printable ASCII counts as '?'.
  [[nodiscard]] double advance(char character) const;

  /// Width of a line of text in pixels.
  [[nodiscard]] double width(std::string_view text) const;

  /// The glyph for a pen at `shift` quarters of a pixel, in [0, kShifts).
  [[nodiscard]] const GlyphCoverage& glyph(char character, int shift) const;

 private:
  double size_;
  std::array<std::array<GlyphCoverage, kShifts>, 95> glyphs_;
};

}  // namespace qsmpc
