// The vehicle's drawn pose at any time of an episode, from the data in the trace.
//
// At each control instant the disturbance makes the true state jump, which would make a video
// jerky. The jump is therefore drawn over the first kEaseTime of the following period: pictures
// within it show the vehicle between the place where it was and the place to which it was moved.
// All other pictures show the recorded motion. The trace itself is not changed.
#pragma once

#include <vector>

#include "harness/trace/drawn_vehicle.hpp"
#include "harness/trace/episode_view.hpp"
#include "models/dynamics/dynamics.hpp"
#include "render/frame.hpp"

namespace qsmpc::harness {

/// The drawn coordinates of `state`; 0 for those that the system lacks.
[[nodiscard]] render::PlanarPose planar_pose(const models::SystemDescription& system,
                                             const Eigen::Ref<const Eigen::VectorXd>& state);

/// Times that differ by less count as equal.
inline constexpr double kTimeTolerance = 1e-9;  // s

/// The pose at the fraction `share` between `a` and `b`, linear in each coordinate.
[[nodiscard]] render::PlanarPose between(const render::PlanarPose& a, const render::PlanarPose& b,
                                         double share);

class EpisodeTrack {
 public:
  static constexpr double kEaseTime = 0.04;  ///< s

  /// Copies what it needs from `view`.
  explicit EpisodeTrack(const EpisodeView& view);

  /// End of the last control period, s; 0 without steps.
  [[nodiscard]] double duration() const { return duration_; }

  /// The vehicle's pose; `time` is clamped to the episode, here and below.
  [[nodiscard]] render::PlanarPose pose(double time) const;

  /// Values of all joints of the MuJoCo model; empty if the trace has none.
  [[nodiscard]] std::vector<double> qpos(double time) const;

  /// The path from the start to `pose(time)`.
  [[nodiscard]] std::vector<render::PlanarPoint> driven_path(double time) const;

  /// Time when the vehicle was at point `index` of the path, which must not be the last, s.
  [[nodiscard]] double path_time(std::size_t index) const { return drawn_[index].time; }

  /// A pose near the vehicle's that moves smoothly, for a camera to follow.
  [[nodiscard]] render::PlanarPose smooth_pose(double time) const;

  /// Distance that the plant itself moved in the control period around `time`, before the
  /// disturbance, divided by the period, m/s; 0 without steps.
  [[nodiscard]] double driven_speed(double time) const;

  /// The smallest rectangle around the path; empty without steps.
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
