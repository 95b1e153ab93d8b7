#include "harness/video/episode_frames.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "controller/control/controller.hpp"
#include "controller/regions/body_outline.hpp"
#include "harness/trace/target_progress.hpp"
#include "harness/video/belief_shape.hpp"
#include "models/constants.hpp"
#include "render/scene/scene_painter.hpp"
#include "render/scene/thinning.hpp"

namespace qsmpc::harness {
namespace {

/// Adds the outcome of a drive that ended at `time` (s), and whether that is a failure.
void add_banner(const EpisodeView& view, double time, render::Frame& frame) {
  const double unsafe = view.first_unsafe_time().value_or(time);
  switch (view.trace().outcome) {
    case Outcome::kReached:
      frame.banner = fmt::format("target reached after {:.1f} s", time);
      break;
    case Outcome::kCollision:
      frame.banner = fmt::format("collision after {:.1f} s", unsafe);
      frame.alarm = true;
      break;
    case Outcome::kLeftBounds:
      frame.banner = fmt::format("left the bounds after {:.1f} s", unsafe);
      frame.alarm = true;
      break;
    case Outcome::kTimeout:
      frame.banner = fmt::format("target not reached in {:.1f} s", time);
      break;
    case Outcome::kFault:
      frame.banner =
          view.trace().fault_of == FaultOf::kController ? "controller fault" : "simulator fault";
      frame.alarm = true;
      break;
    case Outcome::kInterrupted:
      frame.banner = "interrupted";
      break;
  }
}

constexpr double kRailTime = 1.0;  // m/s: on a rail, y is time

std::string every_nth(std::size_t every) { return fmt::format("1 of {}", every); }

}  // namespace

EpisodeFrames::EpisodeFrames(const EpisodeView& view, const Overlays& overlays)
    : view_(view),
      steps_(view.trace().steps),
      overlays_(overlays),
      track_(view),
      on_rail_(is_on_rail(view.system())),
      vehicle_(drawn_vehicle(view)),
      others_(view),
      planar_clearances_(view, world(), others_.driven()),
      ranges_(chart_ranges(view)) {
  if (view.scenario().target.route) waypoints_passed_ = progress_of(view.trace());
  if (overlays_.raw) raw_.emplace(view.scenario());
  if (on_rail_) joints_ = JointPose::of(view.scenario(), view.system(), vehicle_);
  if (overlays_.path) path_clearances_ = path_clearances();
}

std::string EpisodeFrames::heading() const {
  const Scenario& scenario = view_.scenario();
  const bool closed = scenario.controller.policy == "closed_loop";
  const bool planned = scenario.controller.kind == controller::controllers().front().name;
  return fmt::format("{}, {} plant, {}", scenario.name, scenario.plant.kind,
                     !planned ? scenario.controller.kind
                     : closed ? "closed loop"
                              : "open loop");
}

render::PlanarRectangle EpisodeFrames::region() const {
  const render::PlanarRectangle still = render::world_region(world());
  const render::PlanarRectangle way = track_.extent();
  return {std::min(still.x_lower, way.x_lower), std::max(still.x_upper, way.x_upper),
          std::min(still.y_lower, way.y_lower), std::max(still.y_upper, way.y_upper)};
}

double EpisodeFrames::longest_plan() const {
  double longest = 0.0;
  for (const StepRecord& step : steps_) {
    double length = 0.0;
    for (Eigen::Index i = 1; i < step.plan_states.cols(); ++i) {
      const render::PlanarPose from = planar_pose(view_.system(), step.plan_states.col(i - 1));
      const render::PlanarPose to = planar_pose(view_.system(), step.plan_states.col(i));
      length += std::hypot(to.x - from.x, to.y - from.y);
    }
    // A rail's camera looks across it, so it needs more room for the same length.
    constexpr double kAcross = 1.35;
    const auto stages = static_cast<std::size_t>(step.plan_states.cols());
    if (on_rail_) length = std::max(length, -kAcross * lane(stages));
    longest = std::max(longest, length);
  }
  return longest;
}

// Clearances at all points of the driven path except the last, whose time depends on the frame. On
// a rail they are those of the whole state.
std::vector<double> EpisodeFrames::path_clearances() const {
  if (steps_.empty()) return {};
  std::vector<render::PlanarPoint> path = track_.driven_path(kInfinity);
  path.pop_back();
  std::vector<double> times;
  for (std::size_t i = 0; i < path.size(); ++i) {
    times.push_back(std::min(track_.path_time(i), duration()));
  }
  if (!on_rail_) return planar_clearances_.of(path, times);
  std::vector<double> clearances;
  clearances.reserve(times.size());
  for (const double time : times) clearances.push_back(clearance_at(time));
  return clearances;
}

std::size_t EpisodeFrames::step_at(double time) const {
  const auto later =
      std::upper_bound(steps_.begin(), steps_.end(), time + kTimeTolerance,
                       [](double t, const StepRecord& step) { return t < step.time; });
  const auto index = static_cast<std::size_t>(later - steps_.begin());
  return index == 0 ? 0 : index - 1;
}

render::Frame EpisodeFrames::at(double time) const {
  const double now = std::clamp(time, 0.0, duration());
  render::Frame frame;
  frame.time = now;
  frame.title = view_.scenario().name;
  frame.qpos = track_.qpos(now);
  frame.pose = track_.pose(now);
  frame.moving = others_.at(now);
  if (steps_.empty()) {
    add_banner(view_, now, frame);
    return frame;
  }
  frame.followed = track_.smooth_pose(now);
  frame.driven_path = track_.driven_path(now);
  if (overlays_.path) {
    const auto before = static_cast<std::ptrdiff_t>(frame.driven_path.size() - 1);
    frame.clearances.assign(path_clearances_.begin(), path_clearances_.begin() + before);
    frame.clearances.push_back(
        on_rail_ ? clearance_at(now)
                 : planar_clearances_.of({frame.driven_path.back()}, {now}).front());
  }
  const std::size_t step = step_at(now);
  if (step < waypoints_passed_.size()) {
    frame.waypoints_passed = static_cast<std::size_t>(waypoints_passed_[step]);
  }
  frame.hud = hud_rows(view_.trace(), step, now, track_.driven_speed(now));
  add_plan(steps_[step], frame);
  add_belief(steps_[step], frame);
  if (overlays_.ellipses) frame.forecasts = others_.forecasts(step);
  if (overlays_.body) frame.body = body_at(frame.pose);
  if (overlays_.ghost) frame.ghost = ghost(step, now);
  if (on_rail_) put_on_rail(step, now, frame);
  frame.charts = strip_charts(view_, ranges_, step);
  if (time >= duration() - kTimeTolerance) add_banner(view_, duration(), frame);
  return frame;
}

void EpisodeFrames::add_plan(const StepRecord& step, render::Frame& frame) const {
  const models::SystemDescription& system = view_.system();
  for (Eigen::Index i = 0; i < step.plan_states.cols(); ++i) {
    const render::PlanarPose pose = planar_pose(system, step.plan_states.col(i));
    frame.planned_path.push_back({pose.x, pose.y + lane(static_cast<std::size_t>(i))});
  }
}

double EpisodeFrames::lane(std::size_t stage) const {
  return on_rail_ ? -kRailTime * view_.scenario().time_step * static_cast<double>(stage) : 0.0;
}

// Eased as the pose in EpisodeTrack: the disturbance is drawn over the first kEaseTime of a period.
Eigen::VectorXd EpisodeFrames::state_at(std::size_t step, double time) const {
  const Eigen::MatrixXd& states = view_.states();
  const auto k = static_cast<Eigen::Index>(step);
  Eigen::VectorXd from = states.col(k);
  if (k + 1 >= states.cols()) return from;
  const auto before_kick = [this, &states](Eigen::Index at) {
    const Eigen::VectorXd& kick = steps_[static_cast<std::size_t>(at - 1)].disturbance;
    const Eigen::VectorXd state = states.col(at);
    return kick.size() == state.size() ? Eigen::VectorXd(state - kick) : state;
  };
  const double period = view_.scenario().time_step;
  const double share = std::clamp((time - steps_[step].time) / period, 0.0, 1.0);
  const double ease = std::min(EpisodeTrack::kEaseTime / period, 0.5);
  Eigen::VectorXd on_the_way = from + share * (before_kick(k + 1) - from);
  if (k == 0 || share >= ease) return on_the_way;
  return on_the_way + (1.0 - share / ease) * (before_kick(k) - from);
}

// The time when the vehicle was at point `i` of the `count` points of its path until `now`.
double EpisodeFrames::driven_time(std::size_t i, std::size_t count, double now) const {
  return i + 1 < count ? std::min(track_.path_time(i), track_.duration()) : now;
}

// The clearance of the whole state: on a rail, states that are not drawn may be the unsafe ones.
double EpisodeFrames::clearance_at(double time) const {
  const Eigen::VectorXd& clearances = view_.clearances();
  const double last = static_cast<double>(clearances.size() - 1);
  const double period = std::clamp(time / view_.scenario().time_step, 0.0, last);
  const auto k = static_cast<Eigen::Index>(period);
  if (k + 1 >= clearances.size()) return clearances[k];
  const double share = period - static_cast<double>(k);
  return (1.0 - share) * clearances[k] + share * clearances[k + 1];
}

// Sets the vehicle's joints, and places past and future at their times.
void EpisodeFrames::put_on_rail(std::size_t step, double time, render::Frame& frame) const {
  const std::size_t count = frame.driven_path.size();
  for (std::size_t i = 0; i < count; ++i) {
    frame.driven_path[i].y = kRailTime * (time - driven_time(i, count, time));
  }
  // Past and plan move continuously with time, not in steps of a period.
  const double since = kRailTime * (time - steps_[step].time);
  for (render::PlanarPoint& point : frame.planned_path) point.y += since;
  for (render::ParticleStage& stage : frame.particles) {
    for (render::PlanarPoint& point : stage.points) point.y += since;
  }
  for (render::BeliefEllipses& stage : frame.ellipses) {
    stage.half.centre.y += since;
    stage.most.centre.y += since;
  }
  for (render::TubeSection& section : frame.tube) {
    section.left.y += since;
    section.right.y += since;
  }
  frame.followed->y = 0.0;
  if (!joints_) return;
  if (frame.qpos.empty()) frame.qpos = joints_->qpos(state_at(step, time));
  if (!frame.ghost) return;
  const bool known_before = step > 0 && steps_[step - 1].plan_states.cols() > 2;
  const Eigen::MatrixXd& plan = steps_[known_before ? step - 1 : step].plan_states;
  const Eigen::Index stage = known_before ? 1 : 0;
  const double share =
      std::clamp((time - steps_[step].time) / view_.scenario().time_step, 0.0, 1.0);
  frame.ghost_qpos =
      joints_->qpos(plan.col(stage) + share * (plan.col(stage + 1) - plan.col(stage)));
}

render::ParticleStage EpisodeFrames::planar(const controller::DiscreteMeasure& measure,
                                            std::size_t number) const {
  render::ParticleStage stage;
  for (Eigen::Index i = 0; i < measure.size(); ++i) {
    const render::PlanarPose pose = planar_pose(view_.system(), measure.locations.col(i));
    stage.points.push_back({pose.x, pose.y + lane(number)});
    stage.weights.push_back(measure.weights[i]);
  }
  return stage;
}

void EpisodeFrames::add_belief(const StepRecord& step, render::Frame& frame) const {
  std::vector<render::ParticleStage> stages;
  std::vector<PlanarMoments> moments;
  std::size_t points = 0;
  for (const StageParticles& stage : step.particles) {
    stages.push_back(planar(stage, stages.size()));
    moments.push_back(planar_moments(stages.back()));
    points += stages.back().points.size();
  }
  if (overlays_.ellipses) frame.ellipses = belief_ellipses(moments);
  if (overlays_.tube) {
    std::vector<double> bounds;
    for (const controller::StageCertificate& stage : step.certificates)
      bounds.push_back(stage.value);
    frame.tube = belief_tube(moments, bounds);
  }
  if (overlays_.particles) {
    const std::size_t every = render::thinning(points, render::kMostOverlayPoints);
    for (render::ParticleStage& stage : stages) stage = render::thinned(stage, every);
    frame.particles = std::move(stages);
    if (every > 1) frame.hud.push_back({"particles drawn", every_nth(every)});
  }
  if (raw_ && !step.particles.empty()) add_raw_points(step, frame);
}

// Adds as many raw points as the particles leave room for, but at least a quarter of the limit, so
// that some are drawn even if the particles use up the limit.
void EpisodeFrames::add_raw_points(const StepRecord& step, render::Frame& frame) const {
  std::size_t drawn = 0;
  for (const render::ParticleStage& stage : frame.particles) drawn += stage.points.size();
  const std::size_t room =
      std::max(render::kMostOverlayPoints - std::min(drawn, render::kMostOverlayPoints),
               render::kMostOverlayPoints / 4);
  const std::size_t every = render::thinning(raw_->count(step), room);
  std::size_t number = 0;
  for (const controller::DiscreteMeasure& stage : raw_->stages(step)) {
    const render::ParticleStage kept = render::thinned(planar(stage, ++number), every);
    frame.raw_points.insert(frame.raw_points.end(), kept.points.begin(), kept.points.end());
  }
  frame.hud.push_back({"raw points drawn", every > 1 ? every_nth(every) : "all"});
}

// From the previous period's plan; in the first period, or without such a plan, from its own.
std::optional<render::PlanarPose> EpisodeFrames::ghost(std::size_t step, double time) const {
  const bool known_before = step > 0 && steps_[step - 1].plan_states.cols() > 2;
  const Eigen::MatrixXd& states = steps_[known_before ? step - 1 : step].plan_states;
  const Eigen::Index stage = known_before ? 1 : 0;
  if (states.cols() < stage + 2) return std::nullopt;
  const models::SystemDescription& system = view_.system();
  const double share =
      std::clamp((time - steps_[step].time) / view_.scenario().time_step, 0.0, 1.0);
  return between(planar_pose(system, states.col(stage)), planar_pose(system, states.col(stage + 1)),
                 share);
}

std::vector<std::vector<render::PlanarPoint>> EpisodeFrames::body_at(
    const render::PlanarPose& pose) const {
  constexpr double kLongestChord = 0.15;  // rad
  std::vector<std::vector<render::PlanarPoint>> lines;
  for (const controller::Arc& arc :
       controller::body_outline(view_.scenario().safe_set.body, {pose.x, pose.y}, pose.heading)) {
    const int chords = static_cast<int>(std::ceil((arc.to - arc.from) / kLongestChord));
    std::vector<render::PlanarPoint>& line = lines.emplace_back();
    for (int k = 0; k <= chords; ++k) {
      const double angle = arc.from + k * (arc.to - arc.from) / chords;
      line.push_back({arc.centre.x() + arc.radius * std::cos(angle),
                      arc.centre.y() + arc.radius * std::sin(angle)});
    }
  }
  return lines;
}

}  // namespace qsmpc::harness
