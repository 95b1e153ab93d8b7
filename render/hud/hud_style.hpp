// Sizes, fonts and colours shared by the parts of the head-up display.
#pragma once

#include <algorithm>
#include <array>

#include "render/colour.hpp"
#include "render/hud/canvas.hpp"

namespace qsmpc::render {

/// For a picture of this size (pixels). Lengths shrink with the picture; letters stay legible.
struct HudStyle {
  double scale;  ///< 1 for 1280x720
  Font title;
  Font text;
  Font small;
  Font banner;

  HudStyle(int width, int height)
      : scale(std::min(std::max(width, height) / 1280.0, std::min(width, height) / 720.0)),
        title(std::max(17.5 * scale, 11.0)),
        text(std::max(14.0 * scale, 10.0)),
        small(std::max(12.0 * scale, 9.0)),
        banner(std::max(30.0 * scale, 13.0)) {}

  [[nodiscard]] double margin() const { return std::max(16.0 * scale, 4.0); }
  [[nodiscard]] double padding() const { return std::max(14.0 * scale, 6.0); }
  [[nodiscard]] double gap() const { return std::max(8.0 * scale, 4.0); }
  [[nodiscard]] double title_height() const { return 1.95 * title.size(); }
  [[nodiscard]] double row_height() const { return 1.57 * text.size(); }
};

namespace hud_colour {

inline constexpr Colour kPanel{0.055F, 0.075F, 0.11F, 0.80F};
inline constexpr Colour kBand{0.075F, 0.095F, 0.13F};
inline constexpr Colour kChartGround{0.0F, 0.0F, 0.0F, 0.32F};
inline constexpr Colour kChartLine{1.0F, 1.0F, 1.0F, 0.14F};
inline constexpr Colour kLimit{1.0F, 1.0F, 1.0F, 0.85F};
inline constexpr Colour kAlarm{0.72F, 0.10F, 0.07F, 0.92F};  // legible behind white text
inline constexpr Colour kWarning{1.0F, 0.58F, 0.38F};
inline constexpr Colour kText{0.96F, 0.97F, 0.98F};
inline constexpr Colour kFaintText{0.66F, 0.71F, 0.78F};
// Okabe and Ito's colours, distinguishable with any colour vision.
inline constexpr std::array<Colour, 5> kCharts{{{0.34F, 0.71F, 0.91F},
                                                {0.90F, 0.62F, 0.0F},
                                                {0.40F, 0.80F, 0.65F},
                                                {0.87F, 0.55F, 0.74F},
                                                {0.94F, 0.89F, 0.26F}}};

}  // namespace hud_colour

}  // namespace qsmpc::render
