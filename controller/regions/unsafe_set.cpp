#include "controller/regions/unsafe_set.hpp"

#include <algorithm>

#include "controller/named_entry.hpp"
#include "controller/regions/planar/moving_shape.hpp"
#include "controller/regions/planar/road_region.hpp"
#include "controller/regions/planar/shape_region.hpp"
#include "controller/regions/shapes.hpp"
#include "models/constants.hpp"

namespace qsmpc::controller {
namespace {

/// `box` restricted in position only.
Box of_position(Box box, const Body& body) {
  for (Eigen::Index axis = 0; axis < box.lower.size(); ++axis) {
    if (axis == body.x || axis == body.y) continue;
    box.lower[axis] = -kInfinity;
    box.upper[axis] = kInfinity;
  }
  return box;
}

bool restricts_position(const Box& box, const Body& body) {
  const auto axes = bounded_axes(box);
  return std::any_of(axes.begin(), axes.end(), [&](const AxisInterval& interval) {
    return interval.axis == body.x || interval.axis == body.y;
  });
}

DiscView view_of(const SafeSet& safe_set, const Disc& disc, bool first) {
  const Body& body = safe_set.body;
  const Growth growth{.radius = disc.radius, .x = body.x, .y = body.y};
  DiscView view{.placement = DiscPlacement(body, disc), .regions = {}, .bounds = safe_set.bounds};
  if (!first) view.bounds = of_position(view.bounds, body);
  view.regions.push_back(make_region("walls", view.bounds, growth));
  for (Eigen::Index axis = 0; axis < view.bounds.lower.size(); ++axis) {
    if (!growth.grows(axis)) continue;
    view.bounds.lower[axis] += disc.radius;
    view.bounds.upper[axis] -= disc.radius;
  }
  if (safe_set.road) {
    view.regions.push_back(make_road(safe_set.road, growth));
    view.limits = view.regions.size();
  }
  std::size_t moving = 0;
  for (const Obstacle& obstacle : safe_set.obstacles) {
    const PlanarShape* shape = obstacle.shape();
    if (obstacle.motion && safe_set.forecast) {
      view.regions.push_back(make_moving_shape(*shape, growth, safe_set.forecast, moving++));
    } else if (shape != nullptr) {
      view.regions.push_back(make_shape(*shape, growth));
    } else if (first || restricts_position(*obstacle.box(), body)) {
      view.regions.push_back(make_region("box", *obstacle.box(), growth));
    }
  }
  return view;
}

}  // namespace

const std::vector<ShapeEntry>& region_shapes() {
  static const std::vector<ShapeEntry> table = {
      {"walls", "everything outside the intervals", make_walls},
      {"box", "everything inside the intervals", make_box},
  };
  return table;
}

RegionPointer make_region(std::string_view shape, const Box& intervals, const Growth& growth) {
  check_box(intervals, intervals.lower.size(), std::string(shape));
  return named_entry(region_shapes(), shape, "shape").make(intervals, growth);
}

UnsafeSet::UnsafeSet(const SafeSet& safe_set)
    : bounds_(safe_set.bounds), body_(safe_set.body), forecast_(safe_set.forecast) {
  check_safe_set(safe_set);
  const DiscView point = view_of(safe_set, {}, true);
  regions_ = point.regions;
  limits_ = point.limits;
  if (body_.is_point()) discs_.push_back(point);
  for (const Disc& disc : body_.discs) {
    discs_.push_back(view_of(safe_set, disc, discs_.empty()));
    reach_ = std::max(reach_, discs_.back().placement.reach());
    lipschitz_ = std::max(lipschitz_, discs_.back().placement.lipschitz());
  }
}

double clearance(const Eigen::Ref<const Eigen::VectorXd>& state, const UnsafeSet& unsafe,
                 Eigen::Index stage) {
  if (!state.allFinite()) return -kInfinity;
  double least = kInfinity;
  for (const DiscView& disc : unsafe.discs()) {
    const Eigen::VectorXd centre = disc.placement.of(state);
    for (const RegionPointer& region : disc.regions) {
      least = std::min(least, region->signed_distance(stage, centre));
    }
  }
  return least;
}

double distance_to_unsafe(const Eigen::Ref<const Eigen::VectorXd>& state, const UnsafeSet& unsafe,
                          Eigen::Index stage) {
  return std::max(0.0, clearance(state, unsafe, stage));
}

Eigen::VectorXd clearances(const Points& states, const UnsafeSet& unsafe, Eigen::Index stage) {
  Eigen::ArrayXd least = Eigen::ArrayXd::Constant(states.cols(), kInfinity);
  Points moved;
  for (const DiscView& disc : unsafe.discs()) {
    const bool moves = !disc.placement.at_position();
    if (moves) disc.placement.of(states, {.begin = 0, .end = states.cols()}, moved);
    const Points& centres = moves ? moved : states;
    for (const RegionPointer& region : disc.regions) {
      region->lower_to_distances(stage, centres, least);
    }
  }
  // States that are not finite are unsafe; the minima may have dropped a NaN.
  for (const auto& x : states.rowwise()) {
    least = (x.transpose().array().isFinite()).select(least, -kInfinity);
  }
  return least.matrix();
}

void clearances_with_slopes(const Points& states, const UnsafeSet& unsafe, Eigen::Index stage,
                            ClearanceScratch& scratch, NearestFaces& out) {
  out.distance.setConstant(states.cols(), kInfinity);
  out.slope.setZero(states.rows(), states.cols());
  const ParticleRange all{.begin = 0, .end = states.cols()};
  for (const DiscView& disc : unsafe.discs()) {
    if (disc.placement.at_position()) {
      for (const RegionPointer& region : disc.regions) region->lower_to_faces(stage, states, out);
      continue;
    }
    NearestFaces& nearest = scratch.of_disc;
    nearest.distance = out.distance;
    nearest.slope.setZero(states.rows(), states.cols());
    disc.placement.of(states, all, scratch.centres);
    for (const RegionPointer& region : disc.regions) {
      region->lower_to_faces(stage, scratch.centres, nearest);
    }
    scratch.slopes.setZero(states.rows(), states.cols());
    disc.placement.pull_back(states, all, nearest.slope, scratch.slopes);
    for (Eigen::Index i = 0; i < states.cols(); ++i) {
      if (nearest.distance[i] < out.distance[i]) out.slope.col(i) = scratch.slopes.col(i);
    }
    out.distance = nearest.distance;
  }
}

}  // namespace qsmpc::controller
