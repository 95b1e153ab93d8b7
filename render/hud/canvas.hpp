// Flat, anti-aliased drawing onto an image: what the head-up display is made of. Pictures are the
// same from run to run and on any thread; letters depend on the font file that is installed.
//
//   Canvas canvas(image, {16.0, 16.0, 300.0, 80.0});
//   canvas.fill_rectangle({16.0, 16.0, 300.0, 80.0}, colour, 8.0);
//   canvas.draw_text(Font(14.0), "σ = 0.2 µm", {30.0, 40.0}, white);
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "render/colour.hpp"
#include "render/frame.hpp"

#pragma GCC visibility push(default)

namespace qsmpc::render {

/// A place in an image: pixels from its upper left corner, x to the right and y down.
struct PixelPoint {
  double x = 0.0;
  double y = 0.0;
};

struct PixelRectangle {
  double x = 0.0;
  double y = 0.0;
  double width = 0.0;
  double height = 0.0;
};

/// DejaVu Sans at one size; where it is not installed, the font most like it that is; without any
/// font, built-in letters for ASCII.
class Font {
 public:
  /// `size`: pixels per em, > 0.
  explicit Font(double size) : size_(size) {}

  [[nodiscard]] double size() const { return size_; }

  /// Pixels from the start of a line of UTF-8 text to its end. Throws std::runtime_error when
  /// memory runs out.
  [[nodiscard]] double width(std::string_view text) const;

 private:
  double size_;
};

/// `text` as UTF-8, cut and marked with "…" where it is wider than `width` pixels. Throws like
/// Font::width.
[[nodiscard]] std::string fitting(const Font& font, std::string_view text, double width);

/// A part of an image that is drawn on. What lies outside of it is cut off. The image has what was
/// drawn when the canvas is destroyed; until then nobody else may touch that part. All drawing
/// blends by the colour's opacity, and throws std::runtime_error when memory runs out.
class Canvas {
 public:
  /// The pixels that `area` touches, as far as the image has them.
  Canvas(Image& image, const PixelRectangle& area);
  /// The whole of `image`.
  explicit Canvas(Image& image);
  ~Canvas();
  Canvas(const Canvas&) = delete;
  Canvas& operator=(const Canvas&) = delete;

  /// `radius` (pixels): of its corners.
  void fill_rectangle(const PixelRectangle& area, const Colour& colour, double radius = 0.0);

  void fill_circle(const PixelPoint& centre, double radius, const Colour& colour);

  /// A line `width` pixels thick through `points`. A point that is not finite interrupts it.
  void draw_graph(const std::vector<PixelPoint>& points, double width, const Colour& colour);

  /// One line of UTF-8 text; `pen` is the left end of its baseline, which is moved to a whole row.
  /// Bytes that are no character's UTF-8 are each drawn as U+FFFD, control characters as spaces.
  void draw_text(const Font& font, std::string_view text, const PixelPoint& pen,
                 const Colour& colour);

 private:
  struct Surface;
  std::unique_ptr<Surface> surface_;
};

}  // namespace qsmpc::render

#pragma GCC visibility pop
