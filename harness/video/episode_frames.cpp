#include "harness/video/episode_frames.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>

#include <fmt/format.h>

#include "render/scene_painter.hpp"

namespace qsmpc {
namespace {

constexpr double kTimeTolerance = 1e-9;  // s
constexpr double kFlatHalfWidth = 0.5;   // m, of an obstacle in a direction that a system lacks
constexpr std::size_t kMostInputRows = 3;

// The box's sides along x and y.
PlanarRectangle planar_box(const SystemDescription& system, const Box& box, double missing) {
  const auto side = [missing](const Eigen::VectorXd& values, int index, double sign) {
    return index >= 0 ? values[index] : sign * missing;
  };
  return {side(box.lower, system.position_x, -1.0), side(box.upper, system.position_x, 1.0),
          side(box.lower, system.position_y, -1.0), side(box.upper, system.position_y, 1.0)};
}

std::string bound_text(double bound) {
  return bound < 1.0 ? fmt::format("<= {:.2e}", bound) : "no bound below 1";
}

double next_certificate(const StepRecord& step) {
  return step.certificates.empty() ? std::numeric_limits<double>::quiet_NaN()
                                   : step.certificates.front().value;
}

// The decade below the least positive certificate of the episode, for the chart's lower edge.
double certificate_floor(const Trace& trace) {
  constexpr double kHighestFloor = 1e-2;
  constexpr double kLowestFloor = 1e-9;
  double least = kHighestFloor;
  for (const StepRecord& step : trace.steps) {
    const double value = next_certificate(step);
    if (value > 0.0) {
      least = std::min(least, value);
    }
  }
  return std::max(std::pow(10.0, std::floor(std::log10(least))), kLowestFloor);
}

std::string banner(const Trace& trace, double time) {
  switch (trace.outcome) {
    case Outcome::kReached:
      return fmt::format("target reached after {:.1f} s", time);
    case Outcome::kTimeout:
      return fmt::format("target not reached in {:.1f} s", time);
    case Outcome::kLeftSafeSet:
      return fmt::format("left the safe set at {:.1f} s", time);
    case Outcome::kFault:
      return "simulator fault";
    case Outcome::kInterrupted:
      return "interrupted";
  }
  return {};
}

}  // namespace

EpisodeFrames::EpisodeFrames(const Trace& trace)
    : trace_(trace),
      dynamics_(make_dynamics(trace.scenario.model.system, trace.scenario.model.parameters,
                              trace.scenario.time_step)),
      track_(trace, dynamics_->description()),
      least_certificate_(certificate_floor(trace)) {}

World EpisodeFrames::world() const {
  const SystemDescription& system = dynamics_->description();
  const Scenario& scenario = trace_.scenario;
  World world;
  world.bounds =
      planar_box(system, scenario.safe_set.bounds, std::numeric_limits<double>::infinity());
  for (const Box& obstacle : scenario.safe_set.obstacles) {
    world.obstacles.push_back(planar_box(system, obstacle, kFlatHalfWidth));
  }
  const PlanarPose target = planar_pose(system, scenario.target.state);
  world.target = {target.x, target.y};
  world.target_radius = scenario.target.radius;
  return world;
}

PlanarRectangle EpisodeFrames::region() const {
  const PlanarRectangle still = world_region(world());
  const PlanarRectangle way = track_.extent();
  return {std::min(still.x_lower, way.x_lower), std::max(still.x_upper, way.x_upper),
          std::min(still.y_lower, way.y_lower), std::max(still.y_upper, way.y_upper)};
}

double EpisodeFrames::longest_plan() const {
  double longest = 0.0;
  for (const StepRecord& step : trace_.steps) {
    double length = 0.0;
    for (Eigen::Index i = 1; i < step.plan_states.cols(); ++i) {
      const PlanarPose from = planar_pose(dynamics_->description(), step.plan_states.col(i - 1));
      const PlanarPose to = planar_pose(dynamics_->description(), step.plan_states.col(i));
      length += std::hypot(to.x - from.x, to.y - from.y);
    }
    longest = std::max(longest, length);
  }
  return longest;
}

std::size_t EpisodeFrames::step_at(double time) const {
  const auto later =
      std::upper_bound(trace_.steps.begin(), trace_.steps.end(), time + kTimeTolerance,
                       [](double t, const StepRecord& step) { return t < step.time; });
  const auto index = static_cast<std::size_t>(later - trace_.steps.begin());
  return index == 0 ? 0 : index - 1;
}

Frame EpisodeFrames::at(double time) const {
  const double now = std::clamp(time, 0.0, duration());
  Frame frame;
  frame.time = now;
  frame.title = trace_.scenario.name;
  frame.qpos = track_.qpos(now);
  frame.pose = track_.pose(now);
  if (trace_.steps.empty()) {
    frame.banner = banner(trace_, now);
    return frame;
  }
  frame.followed = track_.smooth_pose(now);
  frame.driven_path = track_.driven_path(now);
  const std::size_t step = step_at(now);
  add_plan(trace_.steps[step], frame);
  frame.hud = rows(trace_.steps[step], now);
  frame.charts = charts(step);
  if (time >= duration() - kTimeTolerance) {
    frame.banner = banner(trace_, duration());
  }
  return frame;
}

void EpisodeFrames::add_plan(const StepRecord& step, Frame& frame) const {
  const SystemDescription& system = dynamics_->description();
  for (Eigen::Index i = 0; i < step.plan_states.cols(); ++i) {
    const PlanarPose pose = planar_pose(system, step.plan_states.col(i));
    frame.planned_path.push_back({pose.x, pose.y});
  }
  for (const StageParticles& stage : step.particles) {
    ParticleStage drawn;
    for (Eigen::Index i = 0; i < stage.locations.cols(); ++i) {
      const PlanarPose pose = planar_pose(system, stage.locations.col(i));
      drawn.points.push_back({pose.x, pose.y});
      drawn.weights.push_back(stage.weights[i]);
    }
    frame.particles.push_back(std::move(drawn));
  }
}

std::vector<HudRow> EpisodeFrames::rows(const StepRecord& step, double time) const {
  const SystemDescription& system = dynamics_->description();
  const ParameterMap& parameters = trace_.scenario.model.parameters;
  const auto constant_speed = parameters.find("speed");
  const double speed =
      constant_speed != parameters.end() ? constant_speed->second : track_.smooth_speed(time);
  std::vector<HudRow> rows;
  rows.push_back({"time", fmt::format("{:.1f} s", time)});
  rows.push_back({"speed", fmt::format("{:.2f} m/s", speed)});
  const std::size_t inputs = std::min(system.inputs.size(), kMostInputRows);
  for (std::size_t i = 0; i < inputs; ++i) {
    rows.push_back({"input " + system.inputs[i].name,
                    fmt::format("{:+.3f} {}", step.input[static_cast<Eigen::Index>(i)],
                                system.inputs[i].unit)});
  }
  rows.push_back({"cost of plan", fmt::format("{:.1f}", step.cost.total())});
  if (!step.certificates.empty()) {
    rows.push_back({"P(unsafe) next step", bound_text(next_certificate(step))});
    rows.push_back({"P(unsafe) whole plan", bound_text(horizon_bound(step.certificates))});
  }
  rows.push_back({"planning time", fmt::format("{:.0f} ms{}", step.timing.total,
                                               step.fallback ? ", fallback" : "")});
  return rows;
}

std::vector<StripChart> EpisodeFrames::charts(std::size_t step) const {
  const SystemDescription& system = dynamics_->description();
  const Scenario::Controller& controller = trace_.scenario.controller;
  std::vector<StripChart> charts;
  if (!system.inputs.empty()) {
    StripChart input;
    input.label = fmt::format("{} [{}]", system.inputs[0].name, system.inputs[0].unit);
    const bool bounded = controller.input_lower.size() > 0 && controller.input_upper.size() > 0;
    input.lower = bounded ? controller.input_lower[0] : system.input_lower[0];
    input.upper = bounded ? controller.input_upper[0] : system.input_upper[0];
    charts.push_back(std::move(input));
  }
  StripChart certificate;
  certificate.label = "P(unsafe) next step, upper bound (log)";
  certificate.lower = least_certificate_;
  certificate.upper = 1.0;
  certificate.logarithmic = true;
  charts.push_back(std::move(certificate));
  for (std::size_t i = 0; i <= step && i < trace_.steps.size(); ++i) {
    if (charts.size() > 1) {
      charts.front().values.push_back(trace_.steps[i].input[0]);
    }
    charts.back().values.push_back(next_certificate(trace_.steps[i]));
  }
  return charts;
}

}  // namespace qsmpc
