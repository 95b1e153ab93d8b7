// The vehicle's MuJoCo model for drawing, without dynamics.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "render/camera.hpp"
#include "render/frame.hpp"
#include "render/gl/gl_shapes.hpp"

namespace qsmpc::render {

/// Marks of a vehicle that are drawn after it.
struct VehicleMarks {
  double length = 0.0;                            ///< m, see Vehicle::length
  std::vector<std::vector<PlanarPoint>> shadows;  ///< outlines on the ground
  std::vector<ColouredPoint> surface;  ///< translucent triangles, shown where it is hidden
  std::vector<ColouredPoint> ghost;    ///< triangles for `draw_translucent`
};

/// Needs an OffscreenContext that is current on the calling thread and outlives the object.
class Vehicle {
 public:
  /// `mjcf_path`: the model's XML. Planes of its world body are not drawn, and its lights are off:
  /// colours are those of the file. `raised`: see EpisodeScene. Throws std::runtime_error with
  /// MuJoCo's message if it cannot be loaded or drawn.
  Vehicle(const std::string& mjcf_path, int width, int height, bool raised = false);
  ~Vehicle();
  Vehicle(const Vehicle&) = delete;
  Vehicle& operator=(const Vehicle&) = delete;

  /// Places the vehicle according to `frame`: at `qpos` or, if that is empty, at `pose`, which sets
  /// x, y and yaw of the first free joint (without one: of the first joints that slide along x and
  /// y and rotate about z); all other coordinates keep the model's defaults. Throws
  /// std::invalid_argument if `qpos` has the wrong size or a value is not finite.
  void place(const Frame& frame);

  /// Clears the picture and draws the vehicle. Later drawing goes to the same picture until
  /// `read_picture`.
  void draw(const View& view);

  /// Waits for all drawing to finish and copies the picture into `out`, which is resized.
  void read_picture(Image& out);

  /// Marks of the vehicle as last placed: shadows, convex and overlapping; its surface in the
  /// colours of its file; and, if `frame` has one, its ghost, which is fainter the nearer it is.
  /// Meshes are drawn as boxes. Throws std::invalid_argument if the ghost's pose is not finite.
  [[nodiscard]] VehicleMarks marks(const Frame& frame);

  /// The longest side of the box about all its visible parts in the model's default pose, m; parts
  /// fixed to the world are not included.
  [[nodiscard]] double length() const;

  /// The highest corner of the boxes about its visible parts, as last placed; empty without any.
  [[nodiscard]] std::optional<SpacePoint> top() const;

  /// Height by which it is raised, m; 0 if it need not be.
  [[nodiscard]] double lift() const;

 private:
  struct Simulator;
  [[nodiscard]] std::vector<std::vector<PlanarPoint>> shadows() const;
  [[nodiscard]] std::vector<ColouredPoint> ghost(const Frame& frame);

  std::unique_ptr<Simulator> simulator_;
};

}  // namespace qsmpc::render
