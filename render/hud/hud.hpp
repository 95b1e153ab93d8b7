// The head-up display: title, rows, strip charts, legend and banner over a finished picture, either
// as a panel on its left or as a band below.
#pragma once

#include "render/frame.hpp"
#include "render/hud/canvas.hpp"
#include "render/hud/hud_style.hpp"

namespace qsmpc::render {

class Hud {
 public:
  /// For pictures of this size (pixels).
  Hud(int width, int height);

  /// Share of the picture's width, on the left, that the panel covers where `frame` has a title,
  /// rows or charts; 0 where it has none. In a picture that is too narrow for a panel, what it says
  /// is one line at the top, and 0 is covered.
  [[nodiscard]] double covered_share(const Frame& frame) const;

  /// Draws panel, legend and banner over `image`, which has this display's size. Rows and charts
  /// for which there is no room are left out, the last ones first.
  void draw(const Frame& frame, Image& image) const;

  /// Draws title, rows and charts into `area`.
  void draw_band(const Frame& frame, const PixelRectangle& area, Image& image) const;

  /// Draws the legend of `frame` into `area`.
  void draw_legend_band(const Frame& frame, const PixelRectangle& area, Image& image) const;

  /// Draws the banner of `frame` into the upper part of `area`.
  void draw_banner(const Frame& frame, const PixelRectangle& area, Image& image) const;

  /// Draws one line of text at the top of `area`.
  void draw_heading(const std::string& text, const PixelRectangle& area, Image& image) const;

  /// Pixels of a band that holds title, rows and, side by side, all of its charts.
  [[nodiscard]] double band_height() const;
  [[nodiscard]] double legend_height(std::size_t lines) const;

 private:
  [[nodiscard]] double panel_width() const;
  void draw_panel(const Frame& frame, Image& image) const;
  void draw_legend(const Frame& frame, Image& image) const;
  // Title and rows in `area`; returns the height that they take.
  double draw_rows(const Frame& frame, const PixelRectangle& area, Canvas& canvas) const;
  void draw_row(const HudRow& row, const PixelRectangle& area, Canvas& canvas) const;

  int width_;
  int height_;
  HudStyle style_;
};

}  // namespace qsmpc::render
