// Options of pictures.
#pragma once

#include <string>

#include "render/frame.hpp"

#pragma GCC visibility push(default)

namespace qsmpc::render {

/// Options of a picture as a whole.
struct PictureOptions {
  int width = 1280;              ///< pixels, at least 64
  int height = 720;              ///< pixels, at least 64
  std::string camera = "chase";  ///< "chase", "top", "fixed", or "split": chase and top
};

/// An episode to be shown.
struct EpisodeScene {
  World world;
  std::string mjcf_path;  ///< the vehicle's XML
  /// Desired distance of the chase camera from its target, m; limited to 5 to 12 vehicle lengths.
  double chase_distance = 0.0;
  /// The region that the top and fixed cameras must show; if of zero area, the world's bounds,
  /// obstacles and target.
  PlanarRectangle region{};
  /// Whether the vehicle stands on a rail along x, raised so that no joint moves a part of it below
  /// the ground; the chase camera then looks along y.
  bool raised = false;
  std::string heading{};  ///< one line above the episode's panes; empty: none
};

/// Options for a single episode, see PictureOptions and EpisodeScene.
struct RenderOptions {
  int width = 1280;
  int height = 720;
  std::string camera = "chase";
  double chase_distance = 0.0;
  PlanarRectangle region;
};

}  // namespace qsmpc::render

#pragma GCC visibility pop
