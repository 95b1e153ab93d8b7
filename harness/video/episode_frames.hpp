// The contents of an episode's pictures, from the view of its trace alone.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "harness/plant/mujoco/joint_pose.hpp"
#include "harness/trace/episode_view.hpp"
#include "harness/video/episode_hud.hpp"
#include "harness/video/episode_track.hpp"
#include "harness/video/episode_world.hpp"
#include "harness/video/moving_bodies.hpp"
#include "harness/video/overlays.hpp"
#include "harness/video/raw_points.hpp"
#include "render/frame.hpp"

namespace qsmpc::harness {

/// Frames of one episode. A system without a position in the plane stands on a rail along x, and y
/// is time, 1 m per second: the future lies in front of it, towards -y, and the past behind it.
/// Const functions may be called from several threads concurrently.
class EpisodeFrames {
 public:
  /// `view` must outlive it.
  explicit EpisodeFrames(const EpisodeView& view, const Overlays& overlays = {});

  /// Time from the start to the end of the last control period, s.
  [[nodiscard]] double duration() const { return track_.duration(); }

  /// The vehicle's XML.
  [[nodiscard]] const std::string& vehicle() const { return vehicle_; }

  /// See is_on_rail.
  [[nodiscard]] bool on_rail() const { return on_rail_; }

  /// Scenario, plant and policy in one line.
  [[nodiscard]] std::string heading() const;

  /// See episode_world.
  [[nodiscard]] render::World world() const { return episode_world(view_); }

  /// The smallest rectangle around the world and the whole driven path; moving obstacles may leave
  /// it.
  [[nodiscard]] render::PlanarRectangle region() const;

  /// Length of the longest plan of the episode, m: how far a camera must see.
  [[nodiscard]] double longest_plan() const;

  /// The ranges of the strip charts; initially those of this episode.
  [[nodiscard]] const ChartRanges& ranges() const { return ranges_; }
  void set_ranges(const ChartRanges& ranges) { ranges_ = ranges; }

  /// The frame at `time` (s); from `duration()` on with a banner that shows the outcome. Plan,
  /// particles, certificate and forecasts are those of the control period that contains `time`.
  /// More than kMostOverlayPoints points are thinned, and a row says so.
  [[nodiscard]] render::Frame at(double time) const;

 private:
  [[nodiscard]] std::size_t step_at(double time) const;
  void add_plan(const StepRecord& step, render::Frame& frame) const;
  void add_belief(const StepRecord& step, render::Frame& frame) const;
  void add_raw_points(const StepRecord& step, render::Frame& frame) const;
  /// The body's outline for the vehicle at `pose`.
  [[nodiscard]] std::vector<std::vector<render::PlanarPoint>> body_at(
      const render::PlanarPose& pose) const;
  [[nodiscard]] std::optional<render::PlanarPose> ghost(std::size_t step, double time) const;
  [[nodiscard]] render::ParticleStage planar(const controller::DiscreteMeasure& measure,
                                             std::size_t stage) const;
  /// On a rail: y of stage `stage` of the plan, m.
  [[nodiscard]] double lane(std::size_t stage) const;
  [[nodiscard]] Eigen::VectorXd state_at(std::size_t step, double time) const;
  [[nodiscard]] double driven_time(std::size_t i, std::size_t count, double now) const;
  [[nodiscard]] double clearance_at(double time) const;
  [[nodiscard]] std::vector<double> path_clearances() const;
  void put_on_rail(std::size_t step, double time, render::Frame& frame) const;

  const EpisodeView& view_;
  const std::vector<StepRecord>& steps_;
  Overlays overlays_;
  EpisodeTrack track_;
  bool on_rail_;
  std::string vehicle_;
  std::optional<JointPose> joints_;  // on a rail
  MovingBodies others_;
  PlanarClearances planar_clearances_;
  std::vector<double> path_clearances_;  // see path_clearances()
  std::optional<RawPoints> raw_;         // if they are drawn
  ChartRanges ranges_;
  std::vector<double> waypoints_passed_;  // at each control instant; empty without waypoints
};

}  // namespace qsmpc::harness
