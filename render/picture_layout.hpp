// The division of a picture of one or two episodes into panes and bands.
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
  int x = 0;  ///< pixels from the picture's upper left corner, as are the following
  int y = 0;
  int width = 0;
  int height = 0;
};

/// Place of the head-up display: beside the pane, below its episode's panes or, in a small picture,
/// as one line above the pane.
enum class HudPlace { kColumn, kBand, kLine };

/// A single episode seen by one camera in a landscape picture: one pane, with the head-up display
/// on its left and the legend below it; only a line above it if that leaves too little of the
/// picture. Otherwise a band per episode below the panes, and the legend below everything. Nothing
/// covers a pane: it shows all that its camera sees.
struct PictureLayout {
  std::vector<PaneLayout> panes;  ///< those of an episode have the same size
  HudPlace place = HudPlace::kBand;
  std::vector<PixelRectangle> bands;  ///< of the display, one per episode
  PixelRectangle legend;              ///< of zero area if there is only a line
};

/// Sizes that the head-up display needs, pixels, see Hud.
struct BandSizes {
  double charts = 0.0;  ///< height of a band
  double legend = 0.0;  ///< height
  double column = 0.0;  ///< width
  double line = 0.0;    ///< height
};

/// `camera`: a name of `camera_kind`, or "split" for chase and top, side by side for one episode in
/// a landscape picture, otherwise one above the other. `episodes`: 1, or 2 side by side. Throws
/// std::invalid_argument on another camera, or if a pane would be smaller than 32 pixels.
[[nodiscard]] PictureLayout picture_layout(int width, int height, const std::string& camera,
                                           std::size_t episodes, const BandSizes& sizes);

}  // namespace qsmpc::render
