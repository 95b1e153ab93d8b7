// The vehicle's MuJoCo model as something to be drawn: no dynamics.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "render/camera.hpp"
#include "render/frame.hpp"
#include "render/gl/gl_shapes.hpp"

namespace qsmpc::render {

/// What belongs to a vehicle and is drawn after it.
struct VehicleMarks {
  double length = 0.0;                            ///< m, see Vehicle::length
  std::vector<std::vector<PlanarPoint>> shadows;  ///< outlines on the ground
  std::vector<ColouredPoint> surface;  ///< triangles, translucent: what shows where it is hidden
  std::vector<ColouredPoint> ghost;    ///< triangles as `draw_translucent` takes them
};

/// Needs an OffscreenContext that is current on the calling thread and outlives it.
class Vehicle {
 public:
  /// `mjcf_path`: the model's XML. Planes that belong to its world are not drawn, and its lamps
  /// are not lit: colours are those of the file. `raised`: see EpisodeScene. Throws
  /// std::runtime_error with MuJoCo's words when it cannot be loaded or drawn.
  Vehicle(const std::string& mjcf_path, int width, int height, bool raised = false);
  ~Vehicle();
  Vehicle(const Vehicle&) = delete;
  Vehicle& operator=(const Vehicle&) = delete;

  /// Puts the vehicle where `frame` says: at `qpos`, or, if that is empty, at `pose`, which sets x,
  /// y and yaw of the first free joint (without one: the first joints that slide along x and y and
  /// turn about z) and leaves the model's own values to all others. Throws std::invalid_argument
  /// when `qpos` has the wrong size or a value is not finite.
  void place(const Frame& frame);

  /// Clears the picture and draws the vehicle. Later drawing goes to the same picture until
  /// `read_picture`.
  void draw(const View& view);

  /// Waits for all drawing and copies the picture into `out`, of which it sets the size.
  void read_picture(Image& out);

  /// Of the vehicle as last placed: shadows, convex and overlapping; its surface in the colours of
  /// its file; and, where `frame` has one, its ghost, which is the fainter the nearer it is. Meshes
  /// are boxes. Throws std::invalid_argument when the ghost's pose is not finite.
  [[nodiscard]] VehicleMarks marks(const Frame& frame);

  /// m, the longest side of the box about all its visible parts, as the model's file has them; what
  /// stands still in the world is no part of it.
  [[nodiscard]] double length() const;

  /// The highest corner of the boxes about its visible parts, as last placed; nothing without such.
  [[nodiscard]] std::optional<SpacePoint> top() const;

  /// m, that it is raised by; 0 where it need not be.
  [[nodiscard]] double lift() const;

 private:
  struct Simulator;
  [[nodiscard]] std::vector<std::vector<PlanarPoint>> shadows() const;
  [[nodiscard]] std::vector<ColouredPoint> ghost(const Frame& frame);

  std::unique_ptr<Simulator> simulator_;
};

}  // namespace qsmpc::render
