// How a picture of one or two episodes is divided into panes and bands.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "render/camera.hpp"
#include "render/hud/canvas.hpp"

namespace qsmpc::render {

/// A part of the picture in which one camera shows one episode.
struct PaneLayout {
  std::size_t episode = 0;
  CameraKind camera = CameraKind::kChase;
  int x = 0;  ///< pixels from the picture's upper left corner, and so below
  int y = 0;
  int width = 0;
  int height = 0;
};

/// Where the head-up display stands: beside the pane, or below its episode's panes, or, in a small
/// picture, as one line above the pane.
enum class HudPlace { kColumn, kBand, kLine };

/// One episode alone, seen by one camera, in a landscape picture: one pane, the head-up display on
/// its left and the legend below it; only a line above it where that leaves too little of the
/// picture. Otherwise a band below the panes (one an episode), and the legend below all. Nothing
/// lies over a pane: it shows all that its camera sees.
struct PictureLayout {
  std::vector<PaneLayout> panes;  ///< those of an episode have the same size
  HudPlace place = HudPlace::kBand;
  std::vector<PixelRectangle> bands;  ///< of the display, one an episode
  PixelRectangle legend;              ///< of no area where there is a line only
};

/// Pixels that the head-up display needs, see Hud.
struct BandSizes {
  double charts = 0.0;  ///< height of a band
  double legend = 0.0;  ///< height
  double column = 0.0;  ///< width
  double line = 0.0;    ///< height
};

/// `camera`: of `camera_kind`, or "split" for chase and top, which stand side by side for one
/// episode in a landscape picture and one above the other else. `episodes`: 1, or 2 side by side.
/// Throws std::invalid_argument on another camera, or where no pane of 32 pixels is left.
[[nodiscard]] PictureLayout picture_layout(int width, int height, const std::string& camera,
                                           std::size_t episodes, const BandSizes& sizes);

}  // namespace qsmpc::render
