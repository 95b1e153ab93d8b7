// Pictures of frames: a vehicle, its surroundings, what is planned, and a head-up display.
//
//   qsmpc::render::Renderer renderer({.camera = "top"}, world, "models/mjcf/dubins_car.xml");
//   qsmpc::render::Image image;
//   renderer.draw(frame, image);
//
// The same frame gives the same image, whatever was drawn before and on whichever thread.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "render/frame.hpp"
#include "render/hud/canvas.hpp"
#include "render/render_options.hpp"

#pragma GCC visibility push(default)

namespace qsmpc::render {

/// Use and destroy it on the thread that made it; at most one a thread at a time. Different threads
/// may have one each.
class Renderer {
 public:
  /// `mjcf_path`: the vehicle's XML. Throws std::invalid_argument on a size or camera that is none,
  /// std::runtime_error when there is no off-screen OpenGL or the vehicle cannot be loaded.
  Renderer(const RenderOptions& options, const World& world, const std::string& mjcf_path);

  /// Of one episode, or of two side by side, in pictures of `size`. Throws as above, and
  /// std::invalid_argument on another number of episodes.
  Renderer(const PictureOptions& size, const std::vector<EpisodeScene>& scenes);

  ~Renderer();
  Renderer(const Renderer&) = delete;
  Renderer& operator=(const Renderer&) = delete;

  /// Draws `frame` into `out`, of which it sets the size and which it may be given again and again.
  /// Throws std::invalid_argument when `frame.qpos` does not fit the vehicle or is not finite, or
  /// two episodes are to be shown.
  void draw(const Frame& frame, Image& out);

  /// Draws one frame an episode. Throws as above, and when their numbers differ.
  void draw(const std::vector<Frame>& frames, Image& out);

  /// Where the point at `point` and `height` (m) is drawn in the picture of `frame`, which is that
  /// of the episode in pane `pane`; nothing when it is behind the camera. Panes are counted by
  /// episode, and chase before top where both are shown. It may lie outside of its pane.
  [[nodiscard]] std::optional<PixelPoint> locate(const Frame& frame, const PlanarPoint& point,
                                                 double height = 0.0, std::size_t pane = 0) const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace qsmpc::render

#pragma GCC visibility pop
