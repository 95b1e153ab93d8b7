#include "render/renderer.hpp"

#include <algorithm>
#include <stdexcept>

#include "render/camera.hpp"
#include "render/gl/offscreen_context.hpp"
#include "render/gl/smoothing.hpp"
#include "render/hud/hud.hpp"
#include "render/picture_layout.hpp"
#include "render/scene/scene_painter.hpp"
#include "render/scene/vehicle.hpp"

namespace qsmpc::render {
namespace {

constexpr int kLeastSide = 64;               // pixels
constexpr int kLargestSide = 8192;           // pixels
constexpr double kChaseLengths = 5.0;        // vehicle lengths from the chase camera
constexpr double kFarthestChase = 2.4;       // times the nearest: the vehicle stays recognisable
constexpr double kLeastChaseDistance = 0.5;  // m
constexpr std::size_t kLegendLines = 2;      // in a band

void check(const PictureOptions& options, std::size_t episodes) {
  if (options.width < kLeastSide || options.height < kLeastSide || options.width > kLargestSide ||
      options.height > kLargestSide) {
    throw std::invalid_argument("picture of " + std::to_string(options.width) + "x" +
                                std::to_string(options.height) + " pixels: each side must be " +
                                std::to_string(kLeastSide) + " to " + std::to_string(kLargestSide));
  }
  if (episodes < 1 || episodes > 2) {
    throw std::invalid_argument("picture of " + std::to_string(episodes) +
                                " episodes: it must show one or two");
  }
}

PlanarRectangle shown_region(const EpisodeScene& scene) {
  const PlanarRectangle& region = scene.region;
  const bool given = region.x_upper > region.x_lower && region.y_upper > region.y_lower;
  return given ? region : world_region(scene.world);
}

PictureLayout checked_layout(const PictureOptions& options, const Hud& hud, std::size_t episodes) {
  check(options, episodes);
  return picture_layout(options.width, options.height, options.camera, episodes,
                        {.charts = hud.band_height(),
                         .legend = hud.legend_height(kLegendLines),
                         .column = hud.column_width(),
                         .line = hud.heading_height()});
}

PixelRectangle area_of(const PaneLayout& pane) {
  return {static_cast<double>(pane.x), static_cast<double>(pane.y), static_cast<double>(pane.width),
          static_cast<double>(pane.height)};
}

void copy_into(const Image& part, int x, int y, Image& whole) {
  const auto row = 3 * static_cast<std::size_t>(part.width);
  for (int line = 0; line < part.height; ++line) {
    const auto to = 3 * (static_cast<std::size_t>(y + line) * whole.width + x);
    std::copy_n(part.rgb.data() + static_cast<std::size_t>(line) * row, row, &whole.rgb[to]);
  }
}

// The drawing of one episode; all its panes have the same size.
struct Stage {
  double chase_distance;
  PlanarRectangle region;
  PlanarPoint target;
  bool raised;
  std::string heading;
  Vehicle vehicle;
  ScenePainter painter;

  Stage(const EpisodeScene& scene, const PaneLayout& pane)
      : chase_distance(scene.chase_distance),
        region(shown_region(scene)),
        target(scene.world.target),
        raised(scene.raised),
        heading(scene.heading),
        vehicle(scene.mjcf_path, pane.width, pane.height, scene.raised),
        painter(scene.world, region) {}

  [[nodiscard]] View view(const Frame& frame, const PaneLayout& pane) const {
    const PictureSize size{pane.width, pane.height};
    if (pane.camera != CameraKind::kChase) {
      return region_view(pane.camera, region, size);
    }
    const double by_length = kChaseLengths * vehicle.length();
    const double nearest = std::max(by_length, kLeastChaseDistance);
    const double distance = std::clamp(chase_distance, nearest, kFarthestChase * nearest);
    const PlanarPose followed = frame.followed.value_or(frame.pose);
    constexpr double kRaisedAim = 0.6;  // of the height by which the vehicle is raised
    return raised ? rail_view(followed, kRaisedAim * vehicle.lift(), distance, size)
                  : chase_view(followed, distance, size);
  }

  void draw(const Frame& frame, const View& view, SmoothingWorkspace& smoothing, Image& out) {
    vehicle.place(frame);
    vehicle.draw(view);
    painter.paint(frame, view, vehicle.marks(frame));
    vehicle.read_picture(out);
    smooth_edges(out, smoothing);
  }
};

}  // namespace

struct Renderer::Parts {
  PictureOptions options;
  Hud hud;
  PictureLayout layout;
  OffscreenContext context;  // declared before its users
  std::vector<std::unique_ptr<Stage>> stages;
  SmoothingWorkspace smoothing;
  Image pane_picture;

  Parts(const PictureOptions& given, const std::vector<EpisodeScene>& scenes)
      : options(given),
        hud(given.width, given.height),
        layout(checked_layout(given, hud, scenes.size())) {
    for (std::size_t i = 0; i < scenes.size(); ++i) {
      const auto pane = std::find_if(layout.panes.begin(), layout.panes.end(),
                                     [i](const PaneLayout& p) { return p.episode == i; });
      stages.push_back(std::make_unique<Stage>(scenes[i], *pane));
    }
  }

  [[nodiscard]] View view(const Frame& frame, const PaneLayout& pane) const {
    return stages[pane.episode]->view(frame, pane);
  }

  // In pixels of the picture; empty if it is behind the camera.
  [[nodiscard]] std::optional<PixelPoint> place(const Frame& frame, const PaneLayout& pane,
                                                const SpacePoint& point) const {
    std::optional<PixelPoint> at = project(view(frame, pane), point);
    if (at) *at = {at->x + pane.x, at->y + pane.y};
    return at;
  }

  // Points that a banner must not cover.
  [[nodiscard]] std::vector<PixelPoint> main_places(const Frame& frame,
                                                    const PaneLayout& pane) const {
    const Stage& stage = *stages[pane.episode];
    const double height = 0.5 * stage.vehicle.length();
    std::vector<SpacePoint> points = {SpacePoint{frame.pose.x, frame.pose.y, 0.0},
                                      SpacePoint{frame.pose.x, frame.pose.y, height},
                                      SpacePoint{stage.target.x, stage.target.y, 0.0},
                                      SpacePoint{stage.target.x, stage.target.y, kPostHeight}};
    // The pose of a system on a rail is the place below the rail.
    if (const auto top = stage.vehicle.top(); stage.raised && top) points.push_back(*top);
    std::vector<PixelPoint> places;
    for (const SpacePoint& point : points) {
      if (const auto at = place(frame, pane, point)) places.push_back(*at);
    }
    return places;
  }

  void draw_hud(const Frame& frame, const PixelRectangle& area, Image& out) const {
    switch (layout.place) {
      case HudPlace::kColumn:
        hud.draw_column(frame, area, out);
        break;
      case HudPlace::kBand:
        hud.draw_band(frame, area, out);
        break;
      case HudPlace::kLine:
        hud.draw_line(frame, area, out);
        break;
    }
  }

  void draw_panes(const std::vector<const Frame*>& frames, Image& out) {
    out.width = options.width;
    out.height = options.height;
    out.rgb.assign(3 * static_cast<std::size_t>(out.width) * static_cast<std::size_t>(out.height),
                   0);
    for (const PaneLayout& pane : layout.panes) {
      const Frame& frame = *frames[pane.episode];
      stages[pane.episode]->draw(frame, view(frame, pane), smoothing, pane_picture);
      copy_into(pane_picture, pane.x, pane.y, out);
    }
    for (std::size_t i = 0; i < frames.size(); ++i) {
      const auto first = std::find_if(layout.panes.begin(), layout.panes.end(),
                                      [i](const PaneLayout& p) { return p.episode == i; });
      if (!stages[i]->heading.empty()) hud.draw_heading(stages[i]->heading, area_of(*first), out);
      draw_hud(*frames[i], layout.bands[i], out);
      hud.draw_banner(*frames[i], area_of(*first), main_places(*frames[i], *first), out);
    }
    if (layout.legend.height > 0.0) hud.draw_legend_band(*frames.front(), layout.legend, out);
  }

  void draw(const std::vector<const Frame*>& frames, Image& out) {
    if (frames.size() != stages.size()) {
      throw std::invalid_argument("picture of " + std::to_string(stages.size()) +
                                  " episodes: given " + std::to_string(frames.size()) + " frames");
    }
    draw_panes(frames, out);
  }
};

Renderer::Renderer(const RenderOptions& options, const World& world, const std::string& mjcf_path)
    : Renderer({.width = options.width, .height = options.height, .camera = options.camera},
               {{.world = world,
                 .mjcf_path = mjcf_path,
                 .chase_distance = options.chase_distance,
                 .region = options.region}}) {}

Renderer::Renderer(const PictureOptions& size, const std::vector<EpisodeScene>& scenes)
    : parts_(std::make_unique<Parts>(size, scenes)) {}

Renderer::~Renderer() = default;

void Renderer::draw(const Frame& frame, Image& out) { parts_->draw({&frame}, out); }

void Renderer::draw(const std::vector<Frame>& frames, Image& out) {
  std::vector<const Frame*> pointers;
  pointers.reserve(frames.size());
  for (const Frame& frame : frames) pointers.push_back(&frame);
  parts_->draw(pointers, out);
}

std::optional<PixelPoint> Renderer::locate(const Frame& frame, const PlanarPoint& point,
                                           double height, std::size_t pane) const {
  return parts_->place(frame, parts_->layout.panes.at(pane), {point.x, point.y, height});
}

}  // namespace qsmpc::render
