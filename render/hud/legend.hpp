// The legend of a picture's colours.
#pragma once

#include <string>
#include <vector>

#include "render/frame.hpp"
#include "render/hud/canvas.hpp"
#include "render/hud/hud_style.hpp"

namespace qsmpc::render {

class Legend {
 public:
  /// The legend of everything that `frame` shows, in at most `most_lines` lines of at most `width`
  /// pixels.
  Legend(const Frame& frame, const HudStyle& style, double width, std::size_t most_lines);

  /// Pixels of all its lines, without a margin.
  [[nodiscard]] double width() const { return width_; }
  [[nodiscard]] double height() const;

  /// Draws it with its upper left corner at `corner`.
  void draw(const PixelPoint& corner, Canvas& canvas) const;

 private:
  struct Entry {
    enum class Mark { kDots, kLine, kPatch, kRamp, kRing };
    std::string text;
    Mark mark = Mark::kLine;
    std::vector<Colour> colours;
    double x = 0.0;  // pixels from the left
    std::size_t line = 0;
  };

  static std::vector<Entry> entries_of(const Frame& frame);
  [[nodiscard]] double mark_width(const Entry& entry) const;
  void draw_mark(const Entry& entry, double x, double middle, Canvas& canvas) const;

  const HudStyle& style_;
  std::vector<Entry> entries_;
  double width_ = 0.0;
  std::size_t lines_ = 0;
};

}  // namespace qsmpc::render
