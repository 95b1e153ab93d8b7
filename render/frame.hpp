// The contents of a picture as plain values, independent of planners and episodes.
// Lengths are metres in the plane of the ground unless a name says otherwise; text is UTF-8.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#pragma GCC visibility push(default)

namespace qsmpc::render {

struct PlanarPoint {
  double x = 0.0;
  double y = 0.0;
};

struct PlanarRectangle {
  double x_lower = 0.0;
  double x_upper = 0.0;
  double y_lower = 0.0;
  double y_upper = 0.0;
};

struct PlanarPose {
  double x = 0.0;
  double y = 0.0;
  double heading = 0.0;  ///< rad
};

/// The points p with normal · p ≥ offset; the normal has any non-zero length.
struct PlanarHalfPlane {
  PlanarPoint normal;
  double offset = 0.0;
};

/// An upright obstacle of any outline.
struct Prism {
  std::vector<PlanarPoint> outline;              ///< corners of a polygon, counterclockwise
  std::vector<std::vector<PlanarPoint>> pieces;  ///< convex polygons that make it up
};

/// A line on the ground: the edge of a road, or its middle.
struct RoadLine {
  std::vector<PlanarPoint> points;
  bool is_edge = true;
};

/// Everything that stands still during an episode.
struct World {
  PlanarRectangle bounds;                  ///< the safe set's box; infinite sides are not drawn
  std::vector<PlanarRectangle> obstacles;  ///< boxes; sides may be infinite
  PlanarPoint target;
  double target_radius = 0.5;
  std::vector<Prism> prisms;                 ///< obstacles, like the following
  std::vector<PlanarHalfPlane> half_planes;  ///< drawn as far as the ground reaches
  std::vector<RoadLine> road{};
  std::vector<PlanarPoint> waypoints{};  ///< to be passed on the way to the target, in order
  double waypoint_radius = 0.5;
};

/// The weighted points of one stage of the horizon.
struct ParticleStage {
  std::vector<PlanarPoint> points;
  std::vector<double> weights;  ///< as many as points; they sum to one
};

/// An ellipse: its centre, and the vectors from the centre to the ends of its two axes.
struct PlanarEllipse {
  PlanarPoint centre;
  PlanarPoint first_axis;
  PlanarPoint second_axis;
};

/// The smallest ellipses that contain 50 % and 95 % of a Gaussian with one stage's moments.
struct BeliefEllipses {
  PlanarEllipse half;
  PlanarEllipse most;
};

/// The tube along the plan at one place: its two edges and the probability bound there.
struct TubeSection {
  PlanarPoint left;
  PlanarPoint right;
  double bound = 1.0;  ///< of the probability of being unsafe, in [0, 1]
};

/// One of the ways in which an obstacle may move, up to the horizon of the plan.
struct ForecastWay {
  double weight = 1.0;                  ///< probability of this way
  std::vector<PlanarPoint> way;         ///< of its centre, from now to the plan's end
  std::vector<PlanarEllipse> ellipses;  ///< about its centre, at some times from now to the end
};

/// A horizontal line in a strip chart, e.g. a deadline.
struct ChartLimit {
  double value = 0.0;
  std::string label{};
};

/// One strip chart of the head-up display: the history of a quantity up to now.
struct StripChart {
  std::string label{};           ///< e.g. "yaw_rate [rad/s]"
  std::string value{};           ///< the newest value, as text
  std::vector<double> values{};  ///< one per control period, oldest first
  std::size_t slots = 0;         ///< periods on the time axis; raised to the number of values
  double lower = 0.0;            ///< range of the chart
  double upper = 1.0;
  std::string lower_label{};  ///< of the range's ends; empty: the numbers
  std::string upper_label{};
  bool logarithmic = false;
  std::optional<ChartLimit> limit{};
};

/// A row of the head-up display: a name and a value.
struct HudRow {
  std::string name;
  std::string value;
  bool warning = false;  ///< in the warning colour
};

/// One moment of an episode.
struct Frame {
  double time = 0.0;
  std::vector<double> qpos;  ///< pose of every joint of the vehicle model; empty: use `pose`
  PlanarPose pose;           ///< pose of the vehicle if `qpos` is empty
  std::optional<PlanarPose> followed;     ///< followed by the chase camera; empty: `pose`
  std::size_t waypoints_passed = 0;       ///< number of the world's waypoints passed; drawn faintly
  std::vector<PlanarPoint> driven_path;   ///< oldest first
  std::vector<double> clearances;         ///< m, at driven_path's points; empty: one colour
  std::vector<PlanarPoint> planned_path;  ///< stage 0 first
  std::vector<ParticleStage> particles;   ///< stage 0 first; coloured by stage, sized by weight
  std::vector<PlanarPoint> raw_points;    ///< the points that were compressed to the particles
  std::vector<BeliefEllipses> ellipses;   ///< stage 0 first; coloured by stage
  std::vector<TubeSection> tube;          ///< from the plan's start to its end; coloured by bound
  std::vector<std::vector<PlanarPoint>> body;  ///< its outline on the ground, line by line
  std::vector<Prism> moving;                   ///< moving obstacles at their current places
  std::vector<ForecastWay> forecasts;          ///< their future places, as the plan assumes them
  std::optional<PlanarPose> ghost;             ///< predicted pose of the vehicle at this time
  std::vector<double> ghost_qpos;  ///< of every joint in it; empty: `qpos`, moved to `ghost`
  std::string title;
  std::vector<HudRow> hud;
  std::vector<StripChart> charts;
  std::string banner;  ///< large text, e.g. "target reached"; empty: none
  bool alarm = false;  ///< the banner reports a failure and is red
};

/// An image ready for encoding: rows from the top, 3 bytes per pixel (red, green, blue).
struct Image {
  int width = 0;
  int height = 0;
  std::vector<unsigned char> rgb;
};

}  // namespace qsmpc::render

#pragma GCC visibility pop
