// The head-up display: title, rows, strip charts, legend and banner over a finished picture.
#pragma once

#include "render/canvas.hpp"
#include "render/frame.hpp"

namespace qsmpc {

class Hud {
 public:
  /// For pictures of this size (pixels).
  Hud(int width, int height);

  /// Share of the picture's width, on the left, that is covered where `frame` has a title, rows or
  /// charts; 0 where it has none.
  [[nodiscard]] double covered_share(const Frame& frame) const;

  /// Draws what `frame` says over `image`, which has this display's size.
  void draw(const Frame& frame, Image& image) const;

 private:
  void draw_panel(const Frame& frame, Image& image) const;
  void draw_row(const HudRow& row, double baseline, Image& image) const;
  void draw_chart(const StripChart& chart, double top, const Colour& colour, Image& image) const;
  void draw_legend(const Frame& frame, Image& image) const;
  void draw_banner(const Frame& frame, Image& image) const;

  int width_;
  int height_;
  double scale_;  // 1 for 1280x720
  Font title_font_;
  Font text_font_;
  Font small_font_;
  Font banner_font_;
};

}  // namespace qsmpc
