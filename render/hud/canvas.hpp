// Flat, anti-aliased drawing onto an image, for the head-up display. Pictures are identical from
// run to run and on any thread; letters depend on the installed font file.
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

/// A point in an image: pixels from its upper left corner, x to the right and y down.
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

/// DejaVu Sans at one size; if it is not installed, the most similar installed font; without any
/// font, built-in letters for ASCII.
class Font {
 public:
  /// `size`: pixels per em, > 0.
  explicit Font(double size) : size_(size) {}

  [[nodiscard]] double size() const { return size_; }

  /// Width of a line of UTF-8 text, pixels. Throws std::runtime_error if memory runs out.
  [[nodiscard]] double width(std::string_view text) const;

 private:
  double size_;
};

/// `text` (UTF-8), truncated and marked with "…" if it is wider than `width` pixels. Throws like
/// Font::width.
[[nodiscard]] std::string fitting(const Font& font, std::string_view text, double width);

/// A part of an image to draw on. Drawing outside it is clipped. The image receives the drawing
/// when the canvas is destroyed; until then nobody else may access that part. All drawing blends
/// with the colour's opacity, and throws std::runtime_error if memory runs out.
class Canvas {
 public:
  /// The pixels of the image that `area` touches.
  Canvas(Image& image, const PixelRectangle& area);
  /// The whole of `image`.
  explicit Canvas(Image& image);
  ~Canvas();
  Canvas(const Canvas&) = delete;
  Canvas& operator=(const Canvas&) = delete;

  /// `radius`: of the rounded corners, pixels.
  void fill_rectangle(const PixelRectangle& area, const Colour& colour, double radius = 0.0);

  void fill_circle(const PixelPoint& centre, double radius, const Colour& colour);

  /// A line `width` pixels thick through `points`. A point that is not finite interrupts it.
  void draw_graph(const std::vector<PixelPoint>& points, double width, const Colour& colour);

  /// One line of UTF-8 text; `pen` is the left end of its baseline, which is moved to a whole row.
  /// Invalid UTF-8 bytes are drawn as U+FFFD each, control characters as spaces.
  void draw_text(const Font& font, std::string_view text, const PixelPoint& pen,
                 const Colour& colour);

 private:
  struct Surface;
  std::unique_ptr<Surface> surface_;
};

}  // namespace qsmpc::render

#pragma GCC visibility pop
