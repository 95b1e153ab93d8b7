// Pictures of frames: a vehicle, its surroundings, its plan and a head-up display.
//
//   qsmpc::render::Renderer renderer({.camera = "top"}, world, "models/mjcf/dubins_car.xml");
//   qsmpc::render::Image image;
//   renderer.draw(frame, image);
//
// The same frame gives the same image, independent of earlier drawing and of the thread.
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

/// Use and destroy it on the thread that created it; at most one per thread at a time. Different
/// threads may have one each.
class Renderer {
 public:
  /// `mjcf_path`: the vehicle's XML. Throws std::invalid_argument on an invalid size or camera,
  /// std::runtime_error if there is no off-screen OpenGL or the vehicle cannot be loaded.
  Renderer(const RenderOptions& options, const World& world, const std::string& mjcf_path);

  /// Shows one episode, or two side by side, in pictures of `size`. Throws as above, and
  /// std::invalid_argument on another number of episodes.
  Renderer(const PictureOptions& size, const std::vector<EpisodeScene>& scenes);

  ~Renderer();
  Renderer(const Renderer&) = delete;
  Renderer& operator=(const Renderer&) = delete;

  /// Draws `frame` into `out`, which is resized and may be reused. Throws std::invalid_argument if
  /// `frame.qpos` does not match the vehicle or is not finite, or if two episodes are to be shown.
  void draw(const Frame& frame, Image& out);

  /// Draws one frame per episode. Throws as above, and if their numbers differ.
  void draw(const std::vector<Frame>& frames, Image& out);

  /// Where the point at `point` and `height` (m) is drawn in the picture if `frame` is that of the
  /// episode in pane `pane`; empty if it is behind the camera. Panes are numbered by episode, with
  /// chase before top if both are shown. The result may lie outside its pane.
  [[nodiscard]] std::optional<PixelPoint> locate(const Frame& frame, const PlanarPoint& point,
                                                 double height = 0.0, std::size_t pane = 0) const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace qsmpc::render

#pragma GCC visibility pop
