#include "render/camera.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace qsmpc::render {
namespace {

constexpr double kRadPerDegree = std::numbers::pi / 180.0;
constexpr double kChaseFieldOfView = 42.0;   // degrees, vertical
constexpr double kChaseElevation = -24.0;    // degrees
constexpr double kChaseLead = 0.26;          // of the distance: the space ahead matters more
constexpr double kRegionFieldOfView = 24.0;  // degrees; narrow, to limit perspective
constexpr double kFixedElevation = -42.0;    // degrees
constexpr double kFixedAzimuth = 68.0;  // degrees; not along an axis, so that boxes show two sides
constexpr double kRegionMargin = 0.07;  // of the picture, left free about the region

double dot(const SpacePoint& a, const SpacePoint& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

struct Aim {
  SpacePoint target;
  double distance;
  double azimuth;        // rad; 0 looks along x
  double elevation;      // rad; negative looks down
  double field_of_view;  // rad, vertical
};

View aimed_view(const Aim& aim, const PictureSize& size) {
  const double ca = std::cos(aim.azimuth);
  const double sa = std::sin(aim.azimuth);
  const double ce = std::cos(aim.elevation);
  const double se = std::sin(aim.elevation);
  View view;
  view.forward = {ce * ca, ce * sa, se};
  view.up = {-se * ca, -se * sa, ce};
  view.right = {sa, -ca, 0.0};
  view.distance = aim.distance;
  for (std::size_t i = 0; i < 3; ++i) {
    view.position[i] = aim.target[i] - aim.distance * view.forward[i];
  }
  view.width = size.width;
  view.height = size.height;
  view.near_plane = 0.02 * aim.distance;
  view.far_plane = 100.0 * aim.distance;
  view.half_height = view.near_plane * std::tan(0.5 * aim.field_of_view);
  view.half_width = view.half_height * size.width / size.height;
  return view;
}

bool shows(const View& view, const PlanarRectangle& region) {
  const double left = kRegionMargin * view.width;
  const double right = (1.0 - kRegionMargin) * view.width;
  const double top = kRegionMargin * view.height;
  const double bottom = (1.0 - kRegionMargin) * view.height;
  for (const double x : {region.x_lower, region.x_upper}) {
    for (const double y : {region.y_lower, region.y_upper}) {
      const auto pixel = project(view, {x, y, 0.0});
      if (!pixel || pixel->x < left || pixel->x > right || pixel->y < top || pixel->y > bottom) {
        return false;
      }
    }
  }
  return true;
}

}  // namespace

CameraKind camera_kind(const std::string& name) {
  if (name == "chase") {
    return CameraKind::kChase;
  }
  if (name == "top") {
    return CameraKind::kTop;
  }
  if (name == "fixed") {
    return CameraKind::kFixed;
  }
  throw std::invalid_argument("camera \"" + name + "\" is not one of chase, top, fixed");
}

View chase_view(const PlanarPose& pose, double distance, const PictureSize& size) {
  const double lead = kChaseLead * distance;
  return aimed_view({.target = {pose.x + lead * std::cos(pose.heading),
                                pose.y + lead * std::sin(pose.heading), 0.0},
                     .distance = distance,
                     .azimuth = pose.heading,
                     .elevation = kChaseElevation * kRadPerDegree,
                     .field_of_view = kChaseFieldOfView * kRadPerDegree},
                    size);
}

View rail_view(const PlanarPose& pose, double height, double distance, const PictureSize& size) {
  return aimed_view({.target = {pose.x, pose.y, height},
                     .distance = distance,
                     .azimuth = 0.5 * std::numbers::pi,
                     .elevation = kChaseElevation * kRadPerDegree,
                     .field_of_view = kChaseFieldOfView * kRadPerDegree},
                    size);
}

View region_view(CameraKind kind, const PlanarRectangle& region, const PictureSize& size) {
  const bool top = kind == CameraKind::kTop;
  Aim aim{.target = {0.5 * (region.x_lower + region.x_upper),
                     0.5 * (region.y_lower + region.y_upper), 0.0},
          .distance = 1.0,
          .azimuth = (top ? 90.0 : kFixedAzimuth) * kRadPerDegree,
          .elevation = (top ? -90.0 : kFixedElevation) * kRadPerDegree,
          .field_of_view = kRegionFieldOfView * kRadPerDegree};
  const double extent =
      std::max({region.x_upper - region.x_lower, region.y_upper - region.y_lower, 0.1});
  double too_near = 0.1 * extent;
  double far_enough = 100.0 * extent;
  constexpr int kHalvings = 40;
  for (int i = 0; i < kHalvings; ++i) {
    aim.distance = 0.5 * (too_near + far_enough);
    (shows(aimed_view(aim, size), region) ? far_enough : too_near) = aim.distance;
  }
  aim.distance = far_enough;
  return aimed_view(aim, size);
}

SpacePoint camera_coordinates(const View& view, const SpacePoint& point) {
  const SpacePoint offset{point[0] - view.position[0], point[1] - view.position[1],
                          point[2] - view.position[2]};
  return {dot(offset, view.right), dot(offset, view.up), dot(offset, view.forward)};
}

std::optional<PixelPoint> project(const View& view, const SpacePoint& point) {
  const SpacePoint seen = camera_coordinates(view, point);
  if (seen[2] < view.near_plane) {
    return std::nullopt;
  }
  const double scale = view.near_plane / seen[2];
  const double across = seen[0] * scale / view.half_width;
  const double upwards = seen[1] * scale / view.half_height;
  return PixelPoint{0.5 * (1.0 + across) * view.width, 0.5 * (1.0 - upwards) * view.height};
}

}  // namespace qsmpc::render
