// Where the vehicle is drawn at any time of an episode, from what the trace holds.
//
// At each control instant the disturbance makes the true state jump. A picture that jumps with it
// is jerky, so the jump is drawn over the first kEaseTime of the following period: pictures within
// it show the vehicle between the place where it was and the place to which it was moved.
// Everywhere else they show the recorded motion. The trace itself is not touched.
#pragma once

#include <vector>

#include "harness/trace/drawn_vehicle.hpp"
#include "harness/trace/episode_view.hpp"
#include "models/dynamics/dynamics.hpp"
#include "render/frame.hpp"

namespace qsmpc::harness {

/// The coordinates of `state` that are drawn; 0 where a system has none.
[[nodiscard]] render::PlanarPose planar_pose(const models::SystemDescription& system,
                                             const Eigen::Ref<const Eigen::VectorXd>& state);

/// Times that differ by less are the same.
inline constexpr double kTimeTolerance = 1e-9;  // s

/// The pose at `share` of the way from `a` to `b`, linear in each coordinate.
[[nodiscard]] render::PlanarPose between(const render::PlanarPose& a, const render::PlanarPose& b,
                                         double share);

class EpisodeTrack {
 public:
  static constexpr double kEaseTime = 0.04;  ///< s

  /// Takes what it needs from `view`.
  explicit EpisodeTrack(const EpisodeView& view);

  /// s, the end of the last control period; 0 without steps.
  [[nodiscard]] double duration() const { return duration_; }

  /// The vehicle's pose; `time` is clamped to the episode, here and below.
  [[nodiscard]] render::PlanarPose pose(double time) const;

  /// Values of all joints of the MuJoCo model; empty where the trace has none.
  [[nodiscard]] std::vector<double> qpos(double time) const;

  /// The way from the start to `pose(time)`.
  [[nodiscard]] std::vector<render::PlanarPoint> driven_path(double time) const;

  /// s, when the vehicle was at point `index` of the way, which is not its last one.
  [[nodiscard]] double path_time(std::size_t index) const { return drawn_[index].time; }

  /// A pose near the vehicle's that moves smoothly: what a camera follows.
  [[nodiscard]] render::PlanarPose smooth_pose(double time) const;

  /// m/s, how far the plant came by itself in the control period about `time`, before the
  /// disturbance, over the period; 0 without steps.
  [[nodiscard]] double driven_speed(double time) const;

  /// The smallest rectangle about the way; of no area without steps.
  [[nodiscard]] render::PlanarRectangle extent() const;

 private:
  struct TimedPose {
    double time = 0.0;
    render::PlanarPose pose;
  };

  void add_poses(const EpisodeView& view);
  void add_motion(const Trace& trace);

  double duration_ = 0.0;
  std::vector<TimedPose> instants_;   // at the control instants, after the jump
  std::vector<double> speeds_;        // m/s, of each period
  std::vector<TimedPose> drawn_;      // with the jumps eased
  std::vector<MotionSample> motion_;  // with the jumps eased
};

}  // namespace qsmpc::harness
