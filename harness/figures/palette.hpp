// The palette of charts and maps: colour numbers, which become the classes c0 … c14 of the page's
// style (web/page.css).
#pragma once

namespace qsmpc::harness {

/// Classes c0 … c5 colour lines and points: those colours of Okabe and Ito's palette, which people
/// with any colour vision can tell apart, that stand out from the background.
inline constexpr int kPaletteSize = 6;
inline constexpr int kBlue = 0;
inline constexpr int kOrange = 1;
inline constexpr int kGreen = 2;
inline constexpr int kPurple = 3;
inline constexpr int kVermilion = 4;
inline constexpr int kSky = 5;

/// Classes c6 and c7, for maps only: the colours of text and of small print.
inline constexpr int kInk = 6;
inline constexpr int kGrey = 7;

/// Classes c8 and c9, for maps only: a plan's first and last stage in the palette of stages that
/// videos and pages share (render/colour.hpp, web/map.js).
inline constexpr int kFirstStage = 8;
inline constexpr int kLastStage = 9;

/// Classes c10 … c14, for maps only: a scale from low to high.
inline constexpr int kFirstScale = 10;
inline constexpr int kScaleSize = 5;

}  // namespace qsmpc::harness
