#include "harness/report/episode_scene.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <limits>
#include <numbers>
#include <optional>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "harness/errors.hpp"
#include "harness/mujoco/vehicle_shapes.hpp"
#include "harness/plant/mujoco/joint_pose.hpp"
#include "harness/report/packed_numbers.hpp"
#include "harness/report/script_json.hpp"
#include "harness/trace/drawn_vehicle.hpp"
#include "harness/trace/vehicle_change.hpp"

namespace qsmpc::harness {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kMostPlacements = 20'000;  // per page: about 0.75 MB as text
constexpr double kTimeTolerance = 1e-9;          // between samples before and after a jump, s

struct TimedParts {
  double time = 0.0;
  std::vector<Placement> parts;
};

/// `place` moved by the fraction `share` of the motion from `before` to `after`.
Placement moved(const Placement& place, double share, const Placement& before,
                const Placement& after) {
  const Eigen::Quaterniond turn = after.rotation * before.rotation.conjugate();
  return {place.position + share * (after.position - before.position),
          Eigen::Quaterniond::Identity().slerp(share, turn) * place.rotation};
}

/// Points along the circle, x and y alternating.
std::vector<double> points_about(const MapCircle& circle) {
  constexpr int kSides = 48;
  std::vector<double> points;
  for (int i = 0; i <= kSides; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / kSides;
    points.insert(points.end(), {circle.centre.x + circle.radius * std::cos(angle),
                                 circle.centre.y + circle.radius * std::sin(angle)});
  }
  return points;
}

/// Spreads the jump at the end of each period over the whole period.
class SmoothMotion {
 public:
  explicit SmoothMotion(const Trace& trace) : period_(trace.scenario.time_step) {}

  void add(TimedParts sample) {
    const bool jump = !open_.empty() && sample.time - open_.back().time < kTimeTolerance;
    if (jump) close(sample.parts);
    open_.push_back(std::move(sample));
  }

  /// Returns the samples; the object must not be used afterwards.
  [[nodiscard]] std::vector<TimedParts> take() {
    // The last period of a killed episode has no end.
    std::ranges::move(open_, std::back_inserter(samples_));
    return std::move(samples_);
  }

 private:
  void close(const std::vector<Placement>& after) {
    const TimedParts last = open_.back();
    for (TimedParts& sample : open_) {
      const double share = std::clamp(1.0 - (last.time - sample.time) / period_, 0.0, 1.0);
      for (std::size_t part = 0; part < after.size(); ++part) {
        sample.parts[part] = moved(sample.parts[part], share, last.parts[part], after[part]);
      }
    }
    open_.pop_back();  // the next period begins where this one ends
    std::ranges::move(open_, std::back_inserter(samples_));
    open_.clear();
  }

  double period_;
  std::vector<TimedParts> samples_;
  std::vector<TimedParts> open_;
};

class SceneData {
 public:
  /// `joints`: the vehicle's joints for an episode without a simulator's motion; nothing if the
  /// vehicle moves as a whole.
  SceneData(const EpisodeView& view, VehicleShapes& vehicle, const std::optional<JointPose>& joints)
      : view_(view), vehicle_(vehicle), joints_(joints) {}

  [[nodiscard]] Json json(const PlaneMap* ground) {
    Json json = {{"shapes", shapes()}, {"meshes", meshes()}, {"parts", vehicle_.part_count()}};
    add_motion(json);
    if (ground != nullptr) json["ground"] = of_ground(*ground);
    return json;
  }

 private:
  static void add(const Placement& place, std::vector<double>& values) {
    const Eigen::Quaterniond& q = place.rotation;
    const Eigen::Vector3d& p = place.position;
    values.insert(values.end(), {p.x(), p.y(), p.z(), q.x(), q.y(), q.z(), q.w()});
  }

  [[nodiscard]] Json shapes() const {
    Json json = Json::array();
    for (const VehicleShape& shape : vehicle_.shapes()) {
      std::vector<double> place;
      add(shape.place, place);
      Json entry = {{"kind", kind_name(shape.kind)},
                    {"part", shape.part},
                    {"size", shape.size},
                    {"place", place},
                    {"rgba", shape.rgba}};
      if (shape.kind == ShapeKind::kMesh) entry["mesh"] = shape.mesh;
      json.push_back(entry);
    }
    return json;
  }

  static const char* kind_name(ShapeKind kind) {
    switch (kind) {
      case ShapeKind::kBox:
        return "box";
      case ShapeKind::kEllipsoid:
        return "ellipsoid";
      case ShapeKind::kCapsule:
        return "capsule";
      case ShapeKind::kCylinder:
        return "cylinder";
      case ShapeKind::kMesh:
        break;
    }
    return "mesh";
  }

  [[nodiscard]] Json meshes() const {
    static_assert(VehicleShapes::kMostVertices <= std::numeric_limits<std::uint16_t>::max());
    Json json = Json::array();
    for (const VehicleMesh& mesh : vehicle_.meshes()) {
      const std::vector<std::uint16_t> corners(mesh.triangles.begin(), mesh.triangles.end());
      json.push_back(
          {{"vertices", packed_floats(mesh.vertices)}, {"triangles", packed_words(corners)}});
    }
    return json;
  }

  void add_motion(Json& json) {
    std::vector<double> times;
    std::vector<double> places;
    for (const TimedParts& sample : samples()) {
      times.push_back(sample.time);
      for (const Placement& place : sample.parts) add(place, places);
    }
    if (times.empty()) {
      for (const Placement& place : vehicle_.parts_at_origin()) add(place, places);
    }
    json["times"] = packed_floats(times);
    json["places"] = packed_floats(places);
  }

  /// Every n-th sample, so that they fit into the page, and the last one.
  [[nodiscard]] std::vector<TimedParts> samples() {
    SmoothMotion motion(view_.trace());
    for (const MotionSample& sample : view_.trace().motion) {
      if (is_drawable(sample.qpos)) motion.add({sample.time, vehicle_.parts(sample.qpos)});
    }
    if (joints_) {
      const Eigen::MatrixXd& states = view_.states();
      for (Eigen::Index k = 0; k < states.cols(); ++k) {
        if (!states.col(k).allFinite()) continue;
        motion.add({static_cast<double>(k) * view_.scenario().time_step,
                    vehicle_.parts(joints_->qpos(states.col(k)))});
      }
    }
    std::vector<TimedParts> all = motion.take();
    const std::size_t every = 1 + all.size() * vehicle_.part_count() / kMostPlacements;
    std::vector<TimedParts> kept;
    for (std::size_t i = 0; i < all.size(); ++i) {
      if (i % every == 0 || i + 1 == all.size()) kept.push_back(std::move(all[i]));
    }
    return kept;
  }

  static bool is_drawable(const std::vector<double>& qpos) {
    return !qpos.empty() &&
           std::ranges::all_of(qpos, [](double value) { return std::isfinite(value); });
  }

  /// [x lower, x upper, y lower, y upper]; null for non-finite values.
  static Json of_rectangle(const MapRectangle& area) {
    Json json = Json::array();
    for (const double side : {area.x_lower, area.x_upper, area.y_lower, area.y_upper}) {
      json.push_back(std::isfinite(side) ? Json(side) : Json());
    }
    return json;
  }

  static Json of_ground(const PlaneMap& map) {
    Json json = {{"area", of_rectangle(map.area.value_or(map_area(map)))},
                 {"bounds", of_rectangle(map.bounds)},
                 {"obstacles", Json::array()},
                 {"partial", Json::array()},
                 {"polygons", Json::array()},
                 {"halfPlanes", Json::array()},
                 {"lines", Json::array()},
                 {"targets", Json::array()}};
    for (const MapRectangle& box : map.obstacles) json["obstacles"].push_back(of_rectangle(box));
    for (const MapRectangle& box : map.partial_obstacles) {
      json["partial"].push_back(of_rectangle(box));
    }
    for (const MapPolygon& polygon : map.polygons) {
      std::vector<double> corners;
      for (const MapPoint& corner : polygon.corners) {
        corners.insert(corners.end(), {corner.x, corner.y});
      }
      json["polygons"].push_back(packed_floats(corners));
    }
    for (const MapHalfPlane& half_plane : map.half_planes) {
      json["halfPlanes"].push_back({half_plane.normal.x, half_plane.normal.y, half_plane.offset});
    }
    for (const MapPath& line : map.lines) {
      std::vector<double> points;
      for (const MapPoint& point : line.points) points.insert(points.end(), {point.x, point.y});
      json["lines"].push_back({{"points", packed_floats(points)}, {"faint", line.dashed}});
    }
    for (const MapCircle& target : map.targets) {
      if (target.is_waypoint) {
        json["lines"].push_back(
            {{"points", packed_floats(points_about(target))}, {"faint", false}});
        continue;
      }
      json["targets"].push_back({target.centre.x, target.centre.y, target.radius});
    }
    return json;
  }

  const EpisodeView& view_;
  VehicleShapes& vehicle_;
  const std::optional<JointPose>& joints_;
};

/// Whether some motion has a number of coordinates other than that of `vehicle`.
bool is_of_another(const Trace& trace, const VehicleShapes& vehicle) {
  return std::ranges::any_of(trace.motion, [&](const MotionSample& sample) {
    return !sample.qpos.empty() && sample.qpos.size() != vehicle.coordinate_count();
  });
}

/// What the reader has to know about the drawing.
std::string note_of(const Trace& trace, const VehicleShapes& vehicle) {
  std::string note = vehicle_change(trace);
  if (vehicle.boxed() == 0) return note;
  if (!note.empty()) note += ' ';
  return note + fmt::format(
                    "{} of its shapes have more triangles than a page should hold ({} in total) "
                    "and are drawn as boxes.",
                    vehicle.boxed(), VehicleShapes::kMostTriangles);
}

}  // namespace

EpisodeScene episode_scene(const EpisodeView& view, const PlaneMap* ground) {
  const Trace& trace = view.trace();
  const std::string path = drawn_vehicle(view);
  if (path.empty() || trace.steps.empty()) return {};
  const bool has_motion = !trace.motion.empty() && !trace.motion.front().qpos.empty();
  try {
    std::optional<JointPose> joints;
    if (!has_motion && ground == nullptr) {
      joints = JointPose::of(view.scenario(), view.system(), path);
      if (!joints) return {};
    }
    VehicleShapes vehicle(path);
    if (is_of_another(trace, vehicle)) {
      return {.note = fmt::format(
                  "No view in three dimensions: {} is not the model that was driven.", path)};
    }
    if (vehicle.shapes().empty()) {
      return {.note = fmt::format("No view in three dimensions: {} has no visible shapes.", path)};
    }
    return {.data = script_json(SceneData(view, vehicle, joints).json(ground)),
            .note = note_of(trace, vehicle)};
  } catch (const InputError& error) {
    return {.note = fmt::format("No view in three dimensions: {}", error.what())};
  }
}

}  // namespace qsmpc::harness
