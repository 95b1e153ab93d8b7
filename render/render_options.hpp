// What a caller chooses about pictures.
#pragma once

#include <string>

#include "render/frame.hpp"

#pragma GCC visibility push(default)

namespace qsmpc::render {

/// What is chosen for a picture as a whole.
struct PictureOptions {
  int width = 1280;              ///< pixels, at least 64
  int height = 720;              ///< pixels, at least 64
  std::string camera = "chase";  ///< "chase", "top", "fixed", or "split": chase and top
};

/// An episode as something to be looked at.
struct EpisodeScene {
  World world;
  std::string mjcf_path;  ///< the vehicle's XML
  /// m wanted from the chase camera to what it looks at; kept between 5 and 12 vehicle lengths.
  double chase_distance = 0.0;
  /// What the top and fixed cameras must show; of no area: the world's bounds, obstacles and
  /// target.
  PlanarRectangle region{};
  /// Whether the vehicle stands on a rail along x, so high that none of its joints takes it below
  /// the ground; the chase camera then looks along y.
  bool raised = false;
  std::string heading{};  ///< one line above the episode's panes; empty: none
};

/// The choices for one episode, see there.
struct RenderOptions {
  int width = 1280;
  int height = 720;
  std::string camera = "chase";
  double chase_distance = 0.0;
  PlanarRectangle region;
};

}  // namespace qsmpc::render

#pragma GCC visibility pop
