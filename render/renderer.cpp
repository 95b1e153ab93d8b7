#include "render/renderer.hpp"

#include <algorithm>
#include <stdexcept>

#include "render/camera.hpp"
#include "render/hud.hpp"
#include "render/offscreen_context.hpp"
#include "render/palette.hpp"
#include "render/scene_painter.hpp"
#include "render/smoothing.hpp"
#include "render/vehicle.hpp"

namespace qsmpc {
namespace {

constexpr int kLeastSide = 64;               // pixels
constexpr int kLargestSide = 8192;           // pixels
constexpr double kChaseLengths = 6.5;        // vehicle lengths from the chase camera
constexpr double kFarthestChase = 4.0;       // times the nearest: the vehicle stays recognisable
constexpr double kLeastChaseDistance = 0.5;  // m

const RenderOptions& checked(const RenderOptions& options) {
  if (options.width < kLeastSide || options.height < kLeastSide || options.width > kLargestSide ||
      options.height > kLargestSide) {
    throw std::invalid_argument("picture of " + std::to_string(options.width) + "x" +
                                std::to_string(options.height) + " pixels: each side is from " +
                                std::to_string(kLeastSide) + " to " + std::to_string(kLargestSide));
  }
  return options;
}

PlanarRectangle shown_region(const RenderOptions& options, const World& world) {
  const PlanarRectangle& region = options.region;
  const bool given = region.x_upper > region.x_lower && region.y_upper > region.y_lower;
  return given ? region : world_region(world);
}

}  // namespace

struct Renderer::Parts {
  RenderOptions options;
  CameraKind camera;
  PlanarRectangle region;
  OffscreenContext context;  // before what draws with it
  Vehicle vehicle;
  ScenePainter painter;
  Hud hud;
  SmoothingWorkspace smoothing;

  Parts(const RenderOptions& given, const World& world, const std::string& mjcf_path)
      : options(checked(given)),
        camera(camera_kind(given.camera)),
        region(shown_region(given, world)),
        vehicle(mjcf_path, given.width, given.height),
        painter(world, region),
        hud(given.width, given.height) {}

  [[nodiscard]] View view(const Frame& frame) const {
    const PictureSize size{options.width, options.height, hud.covered_share(frame)};
    if (camera != CameraKind::kChase) {
      return region_view(camera, region, size);
    }
    const double by_length = kChaseLengths * vehicle.length();
    const double nearest = std::max(by_length, kLeastChaseDistance);
    const double distance = std::clamp(options.chase_distance, nearest, kFarthestChase * nearest);
    return chase_view(frame.followed.value_or(frame.pose), distance, size);
  }
};

Renderer::Renderer(const RenderOptions& options, const World& world, const std::string& mjcf_path)
    : parts_(std::make_unique<Parts>(options, world, mjcf_path)) {}

Renderer::~Renderer() = default;

void Renderer::draw(const Frame& frame, Image& out) {
  const View view = parts_->view(frame);
  parts_->vehicle.place(frame);
  parts_->vehicle.draw(view);
  std::vector<ColouredPoint> ghost;
  if (frame.ghost) ghost = parts_->vehicle.ghost(*frame.ghost, palette::kGhost);
  parts_->painter.paint(frame, view, parts_->vehicle.shadows(), ghost);
  parts_->vehicle.read_picture(out);
  smooth_edges(out, parts_->smoothing);
  parts_->hud.draw(frame, out);
}

std::optional<PixelPoint> Renderer::locate(const Frame& frame, const PlanarPoint& point,
                                           double height) const {
  return project(parts_->view(frame), {point.x, point.y, height});
}

}  // namespace qsmpc
