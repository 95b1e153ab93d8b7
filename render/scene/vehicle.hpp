// The vehicle's MuJoCo model as something to be drawn: no dynamics.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "render/camera.hpp"
#include "render/frame.hpp"
#include "render/gl/gl_shapes.hpp"

namespace qsmpc::render {

/// Needs an OffscreenContext that is current on the calling thread and outlives it.
class Vehicle {
 public:
  /// `mjcf_path`: the model's XML. Planes that belong to its world are not drawn. Throws
  /// std::runtime_error with MuJoCo's words when it cannot be loaded or drawn.
  Vehicle(const std::string& mjcf_path, int width, int height);
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

  /// Outlines of what its parts keep the sun from, on the ground; convex, overlapping.
  [[nodiscard]] std::vector<std::vector<PlanarPoint>> shadows() const;

  /// The surface of the vehicle as last placed, but with its body at `pose`, as triangles for
  /// `draw_translucent`; meshes as boxes. Throws std::invalid_argument when `pose` is not finite.
  [[nodiscard]] std::vector<ColouredPoint> ghost(const PlanarPose& pose, const Colour& colour);

  /// m, the longest side of the box about all its visible parts, as the model's file has them.
  [[nodiscard]] double length() const;

 private:
  struct Simulator;
  std::unique_ptr<Simulator> simulator_;
};

}  // namespace qsmpc::render
