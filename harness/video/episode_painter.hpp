// Pictures of one episode, or of two side by side, at any time.
//
//   const EpisodePictures pictures(view, {.camera = "split"});   // shared by all drawing threads
//   EpisodePainter painter(pictures);                             // on each drawing thread
//   painter.draw(/*time=*/1.5, image);
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "harness/trace/episode_view.hpp"
#include "harness/video/episode_frames.hpp"
#include "harness/video/overlays.hpp"
#include "render/frame.hpp"
#include "render/renderer.hpp"

namespace qsmpc::harness {

/// The layout of an episode's pictures.
struct VideoLayout {
  int width = 1280;              ///< pixels
  int height = 720;              ///< pixels
  std::string camera = "chase";  ///< "chase", "top", "fixed" or "split"
  Overlays overlays{};
};

/// What is known about the pictures before any is drawn. Const functions may be called from several
/// threads concurrently.
class EpisodePictures {
 public:
  /// `view` (and `beside`, shown on its right, if not null) must outlive it. Throws
  /// std::runtime_error if an episode cannot be drawn, see `why_not_drawn`.
  EpisodePictures(const EpisodeView& view, const VideoLayout& layout,
                  const EpisodeView* beside = nullptr);

  /// Duration of the longer episode, s.
  [[nodiscard]] double duration() const;

  /// One frame per episode. The shorter one stays on its last frame, with its banner.
  [[nodiscard]] std::vector<render::Frame> at(double time) const;

  [[nodiscard]] render::PictureOptions options() const;
  [[nodiscard]] std::vector<render::EpisodeScene> scenes() const;

 private:
  VideoLayout layout_;
  EpisodeFrames frames_;
  std::optional<EpisodeFrames> beside_;
};

/// Draws on the thread that created it; see Renderer.
class EpisodePainter {
 public:
  /// `pictures` must outlive it. Throws as Renderer.
  explicit EpisodePainter(const EpisodePictures& pictures);

  /// The picture at `time` (s). Throws as Renderer::draw.
  void draw(double time, render::Image& out);

 private:
  const EpisodePictures& pictures_;
  render::Renderer renderer_;
};

/// Why an episode cannot be drawn, e.g. "double_integrator has no position in the plane"; empty if
/// it has a position and a vehicle.
[[nodiscard]] std::string why_not_drawn(const EpisodeView& view);

}  // namespace qsmpc::harness
