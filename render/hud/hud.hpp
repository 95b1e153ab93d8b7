// The head-up display: title, rows, strip charts and legend beside the scene, as a column or a
// band, and a banner over it.
#pragma once

#include "render/frame.hpp"
#include "render/hud/canvas.hpp"
#include "render/hud/hud_style.hpp"

namespace qsmpc::render {

class Hud {
 public:
  /// For pictures of this size (pixels).
  Hud(int width, int height);

  /// Draws title, rows and charts into `area`, one below the other. Rows and charts that do not fit
  /// are left out, the last ones first.
  void draw_column(const Frame& frame, const PixelRectangle& area, Image& image) const;

  /// The same side by side.
  void draw_band(const Frame& frame, const PixelRectangle& area, Image& image) const;

  /// Draws the legend of `frame` into `area`.
  void draw_legend_band(const Frame& frame, const PixelRectangle& area, Image& image) const;

  /// Draws title and rows as one line of text into `area`.
  void draw_line(const Frame& frame, const PixelRectangle& area, Image& image) const;

  /// Draws the banner of `frame` into the upper part of `area`, or into its lower part if it covers
  /// fewer of the points `kept` there.
  void draw_banner(const Frame& frame, const PixelRectangle& area,
                   const std::vector<PixelPoint>& kept, Image& image) const;

  /// Draws one line of text at the top of `area`.
  void draw_heading(const std::string& text, const PixelRectangle& area, Image& image) const;

  /// Height, in pixels, of a band with title, rows and all its charts side by side.
  [[nodiscard]] double band_height() const;
  [[nodiscard]] double legend_height(std::size_t lines) const;

  /// Width of a column with title, rows and charts, and height of one line of text, pixels.
  [[nodiscard]] double column_width() const;
  [[nodiscard]] double heading_height() const;

 private:
  // Draws title and rows into `area`; returns their height.
  double draw_rows(const Frame& frame, const PixelRectangle& area, Canvas& canvas) const;
  void draw_row(const HudRow& row, const PixelRectangle& area, Canvas& canvas) const;

  HudStyle style_;
};

}  // namespace qsmpc::render
