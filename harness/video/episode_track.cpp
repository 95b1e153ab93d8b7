#include "harness/video/episode_track.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <limits>
#include <numbers>

namespace qsmpc::harness {
namespace {

constexpr double kCameraWindow = 0.35;  // standard deviation of the camera's smoothing, s

// `angle` plus the multiple of a turn that brings it nearest to `reference`.
double unwrapped(double angle, double reference) {
  constexpr double kTurn = 2.0 * std::numbers::pi;
  return angle - kTurn * std::round((angle - reference) / kTurn);
}

// Index of the last of `items`, sorted by time, that is not later than `time`; 0 if all are later.
template <typename T>
std::size_t last_not_later(const std::vector<T>& items, double time) {
  const auto later = std::upper_bound(items.begin(), items.end(), time,
                                      [](double t, const T& item) { return t < item.time; });
  return later == items.begin() ? 0 : static_cast<std::size_t>(later - items.begin()) - 1;
}

template <typename T>
double share_after(const std::vector<T>& items, std::size_t index, double time) {
  const double span = items[index + 1].time - items[index].time;
  return span > 0.0 ? std::clamp((time - items[index].time) / span, 0.0, 1.0) : 1.0;
}

// Linear in every value. MuJoCo normalises quaternions before use, so they are interpolated by
// nlerp. Neighbouring samples differ by a small rotation, so that neither the quaternions' sign nor
// the varying speed of nlerp matters.
std::vector<double> between(const std::vector<double>& a, const std::vector<double>& b,
                            double share) {
  std::vector<double> values(a.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    values[i] = a[i] + share * (b[i] - a[i]);
  }
  return values;
}

}  // namespace

render::PlanarPose planar_pose(const models::SystemDescription& system,
                               const Eigen::Ref<const Eigen::VectorXd>& state) {
  const auto value = [&state](int index) { return index >= 0 ? state[index] : 0.0; };
  return {value(drawn_x(system)), value(system.position_y), value(system.heading)};
}

render::PlanarPose between(const render::PlanarPose& a, const render::PlanarPose& b, double share) {
  return {a.x + share * (b.x - a.x), a.y + share * (b.y - a.y),
          a.heading + share * (b.heading - a.heading)};
}

EpisodeTrack::EpisodeTrack(const EpisodeView& view) : duration_(view.duration()) {
  if (view.trace().steps.empty()) {
    return;
  }
  add_poses(view);
  add_motion(view.trace());
}

void EpisodeTrack::add_poses(const EpisodeView& view) {
  const Trace& trace = view.trace();
  const models::SystemDescription& system = view.system();
  const Eigen::MatrixXd& states = view.states();
  const auto add_instant = [this](double time, render::PlanarPose pose) {
    if (!instants_.empty()) {
      pose.heading = unwrapped(pose.heading, instants_.back().pose.heading);
    }
    instants_.push_back({time, pose});
  };
  for (std::size_t k = 0; k < trace.steps.size(); ++k) {
    add_instant(trace.steps[k].time, planar_pose(system, states.col(static_cast<Eigen::Index>(k))));
  }
  // A killed episode has no final state: its vehicle stands still for the last period.
  const bool end_is_known = states.cols() > std::ssize(trace.steps);
  add_instant(duration_, planar_pose(system, states.rightCols<1>()));

  // Within a period: from the state at its beginning to that at its end, before the disturbance.
  const double ease_share = std::min(kEaseTime / trace.scenario.time_step, 0.5);
  drawn_.push_back(instants_.front());
  for (std::size_t k = 0; k < trace.steps.size(); ++k) {
    render::PlanarPose end = instants_[k + 1].pose;
    const bool disturbed = end_is_known || k + 1 < trace.steps.size();
    if (disturbed && trace.steps[k].disturbance.size() == trace.steps[k].state.size()) {
      const render::PlanarPose jump = planar_pose(system, trace.steps[k].disturbance);
      end = {end.x - jump.x, end.y - jump.y, end.heading - jump.heading};
    }
    const double span = instants_[k + 1].time - instants_[k].time;
    const render::PlanarPose& start = instants_[k].pose;
    speeds_.push_back(std::hypot(end.x - start.x, end.y - start.y) / span);
    if (k > 0) {
      drawn_.push_back(
          {instants_[k].time + ease_share * span, between(instants_[k].pose, end, ease_share)});
    }
    drawn_.push_back({instants_[k + 1].time, end});
  }
}

void EpisodeTrack::add_motion(const Trace& trace) {
  double instant = -std::numeric_limits<double>::infinity();  // time of the last jump
  for (const MotionSample& sample : trace.motion) {
    if (sample.qpos.empty()) {
      motion_.clear();
      return;
    }
    const bool is_jump = !motion_.empty() && sample.time - motion_.back().time < kTimeTolerance;
    if (is_jump) {
      instant = sample.time;
    } else if (sample.time >= instant + kEaseTime - kTimeTolerance) {
      motion_.push_back(sample);
    }
  }
}

render::PlanarPose EpisodeTrack::pose(double time) const {
  if (drawn_.empty()) {
    return {};
  }
  const std::size_t index = last_not_later(drawn_, time);
  if (index + 1 >= drawn_.size()) {
    return drawn_.back().pose;
  }
  return between(drawn_[index].pose, drawn_[index + 1].pose, share_after(drawn_, index, time));
}

std::vector<double> EpisodeTrack::qpos(double time) const {
  if (motion_.empty()) {
    return {};
  }
  const std::size_t index = last_not_later(motion_, time);
  if (index + 1 >= motion_.size()) {
    return motion_.back().qpos;
  }
  return between(motion_[index].qpos, motion_[index + 1].qpos, share_after(motion_, index, time));
}

std::vector<render::PlanarPoint> EpisodeTrack::driven_path(double time) const {
  std::vector<render::PlanarPoint> path;
  for (const TimedPose& drawn : drawn_) {
    if (drawn.time >= time) {
      break;
    }
    path.push_back({drawn.pose.x, drawn.pose.y});
  }
  const render::PlanarPose now = pose(time);
  path.push_back({now.x, now.y});
  return path;
}

// A line is fitted to the poses near `time`: unlike a mean, it does not lag at the ends.
render::PlanarPose EpisodeTrack::smooth_pose(double time) const {
  const double now = std::clamp(time, 0.0, duration_);
  double weights = 0.0;
  double first = 0.0;
  double second = 0.0;
  std::array<double, 3> sums{};
  std::array<double, 3> moments{};
  for (const TimedPose& instant : instants_) {
    const double offset = instant.time - now;
    const double weight = std::exp(-0.5 * offset * offset / (kCameraWindow * kCameraWindow));
    weights += weight;
    first += weight * offset;
    second += weight * offset * offset;
    const std::array<double, 3> values{instant.pose.x, instant.pose.y, instant.pose.heading};
    for (std::size_t i = 0; i < 3; ++i) {
      sums[i] += weight * values[i];
      moments[i] += weight * offset * values[i];
    }
  }
  const double determinant = weights * second - first * first;
  std::array<double, 3> value{};
  for (std::size_t i = 0; i < 3 && determinant > 0.0; ++i) {
    value[i] = (second * sums[i] - first * moments[i]) / determinant;
  }
  return {value[0], value[1], value[2]};
}

double EpisodeTrack::driven_speed(double time) const {
  if (speeds_.empty()) return 0.0;
  return speeds_[std::min(last_not_later(instants_, time), speeds_.size() - 1)];
}

render::PlanarRectangle EpisodeTrack::extent() const {
  if (instants_.empty()) {
    return {};
  }
  const render::PlanarPose& start = instants_.front().pose;
  render::PlanarRectangle extent{start.x, start.x, start.y, start.y};
  for (const TimedPose& instant : instants_) {
    extent.x_lower = std::min(extent.x_lower, instant.pose.x);
    extent.x_upper = std::max(extent.x_upper, instant.pose.x);
    extent.y_lower = std::min(extent.y_lower, instant.pose.y);
    extent.y_upper = std::max(extent.y_upper, instant.pose.y);
  }
  return extent;
}

}  // namespace qsmpc::harness
