// Cameras of pictures, and the projection of points of the world into a picture.
#pragma once

#include <array>
#include <optional>
#include <string>

#include "render/frame.hpp"
#include "render/hud/canvas.hpp"

namespace qsmpc::render {

/// A point or direction in space: x, y, z in metres, z up.
using SpacePoint = std::array<double, 3>;

enum class CameraKind { kChase, kTop, kFixed };

/// The camera of this name. Throws std::invalid_argument on any other name, listing the cameras.
[[nodiscard]] CameraKind camera_kind(const std::string& name);

struct PictureSize {
  int width = 1280;  ///< pixels
  int height = 720;  ///< pixels
};

/// A camera with its lens. `right`, `up` and `forward` are orthonormal.
struct View {
  SpacePoint position{};
  SpacePoint forward{};
  SpacePoint up{};
  SpacePoint right{};
  double distance = 1.0;     ///< m, to its target
  double near_plane = 0.05;  ///< m
  double far_plane = 500.0;  ///< m
  double half_height = 0.0;  ///< m, half the picture's height in the near plane
  double half_width = 0.0;   ///< m, half its width in the near plane
  int width = 0;             ///< pixels
  int height = 0;            ///< pixels
};

/// From behind and above the vehicle at `pose`, towards a point ahead of it on the ground that is
/// `distance` metres from the camera.
[[nodiscard]] View chase_view(const PlanarPose& pose, double distance, const PictureSize& size);

/// From above and to the side of a rail along x that carries the vehicle at `pose`: the camera
/// looks along y at the point `height` metres above the vehicle's place on the ground, `distance`
/// metres away.
[[nodiscard]] View rail_view(const PlanarPose& pose, double height, double distance,
                             const PictureSize& size);

/// Shows all of `region`, from above (kTop) or obliquely (kFixed).
[[nodiscard]] View region_view(CameraKind kind, const PlanarRectangle& region,
                               const PictureSize& size);

/// Where `point` is drawn; empty if it is behind the camera.
[[nodiscard]] std::optional<PixelPoint> project(const View& view, const SpacePoint& point);

/// `point` in the camera's own axes: right, up, and the distance along the line of sight.
[[nodiscard]] SpacePoint camera_coordinates(const View& view, const SpacePoint& point);

}  // namespace qsmpc::render
