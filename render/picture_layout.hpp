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

/// One episode alone, seen by one camera, in a landscape picture: one pane, the head-up display
/// over it. Otherwise a band with it below the panes (one an episode), and the legend below all.
struct PictureLayout {
  std::vector<PaneLayout> panes;      ///< those of an episode have the same size
  std::vector<PixelRectangle> bands;  ///< none, or one an episode
  PixelRectangle legend;              ///< of no area where there are no bands
};

/// Pixels of the bands, see Hud.
struct BandHeights {
  double charts = 0.0;
  double legend = 0.0;
};

/// `camera`: of `camera_kind`, or "split" for chase and top, which stand side by side for one
/// episode in a landscape picture and one above the other else. `episodes`: 1, or 2 side by side.
/// Throws std::invalid_argument on another camera, or where no pane of 32 pixels is left.
[[nodiscard]] PictureLayout picture_layout(int width, int height, const std::string& camera,
                                           std::size_t episodes, const BandHeights& heights);

}  // namespace qsmpc::render
