#include "render/scene/scene_painter.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "models/constants.hpp"
#include "render/gl/gl_shapes.hpp"
#include "render/gl/shadow.hpp"
#include "render/palette.hpp"
#include "render/scene/belief_painter.hpp"
#include "render/scene/ground_shapes.hpp"
#include "render/scene/outlines.hpp"

namespace qsmpc::render {
namespace {

constexpr double kObstacleHeight = 0.40;  // m
constexpr double kEdgeClearance = 0.004;  // m; otherwise lines are half hidden by their own box
constexpr double kEdgeWidth = 1.5;        // pixels, of edges and stripes
constexpr double kWallHeight = 0.10;      // m
constexpr double kWallThickness = 0.06;   // m
constexpr double kStripeSpacing = 0.35;   // m, of the unsafe set's stripes
constexpr double kStripedReach = 3.0;     // m beyond the region, where stripes end
constexpr double kMostStripes = 120.0;    // across the region
constexpr double kPostSide = 0.018;       // m
constexpr double kTubeHeight = 0.35;      // m
constexpr double kGroundReach = 500.0;    // m beyond the region
constexpr double kGridReach = 40.0;       // cells beyond the region
constexpr double kNearEdge = 1.5;         // extents of everything else, from its middle
constexpr double kFogBegin = 2.2;         // of the camera's distance
constexpr double kFogEnd = 9.0;           // of the camera's distance
constexpr double kPathWidth = 4.0;        // pixels
constexpr double kRoadEdgeWidth = 3.0;    // pixels
constexpr double kRoadMiddleWidth = 1.5;  // pixels
constexpr double kBodyWidth = 1.8;        // pixels
constexpr double kBodyCasing = 4.0;       // pixels

PlanarRectangle grown(const PlanarRectangle& area, double margin) {
  return {area.x_lower - margin, area.x_upper + margin, area.y_lower - margin,
          area.y_upper + margin};
}

// 1 m, or more if that would give too many lines.
double grid_spacing(const PlanarRectangle& region) {
  const double extent = std::max(region.x_upper - region.x_lower, region.y_upper - region.y_lower);
  constexpr double kMostCells = 80.0;
  double spacing = 1.0;
  while (extent / spacing > kMostCells) {
    spacing *= 5.0;
  }
  return spacing;
}

std::vector<SpacePoint> grid_lines(const PlanarRectangle& region) {
  const double spacing = grid_spacing(region);
  const PlanarRectangle area = grown(region, kGridReach * spacing);
  std::vector<SpacePoint> ends;
  for (double i = std::ceil(area.x_lower / spacing); i * spacing <= area.x_upper; ++i) {
    ends.push_back({i * spacing, area.y_lower, 0.0});
    ends.push_back({i * spacing, area.y_upper, 0.0});
  }
  for (double i = std::ceil(area.y_lower / spacing); i * spacing <= area.y_upper; ++i) {
    ends.push_back({area.x_lower, i * spacing, 0.0});
    ends.push_back({area.x_upper, i * spacing, 0.0});
  }
  return ends;
}

PlanarRectangle clipped_to(const PlanarRectangle& bounds, const PlanarRectangle& area) {
  return {std::max(bounds.x_lower, area.x_lower), std::min(bounds.x_upper, area.x_upper),
          std::max(bounds.y_lower, area.y_lower), std::min(bounds.y_upper, area.y_upper)};
}

// One low wall on the outer side of each finite bound.
std::vector<PlanarRectangle> boundary_walls(const PlanarRectangle& bounds,
                                            const PlanarRectangle& region) {
  const PlanarRectangle inner = clipped_to(bounds, grown(region, kGroundReach));
  const PlanarRectangle outer = grown(inner, kWallThickness);
  std::vector<PlanarRectangle> walls;
  if (std::isfinite(bounds.x_lower)) {
    walls.push_back({outer.x_lower, inner.x_lower, outer.y_lower, outer.y_upper});
  }
  if (std::isfinite(bounds.x_upper)) {
    walls.push_back({inner.x_upper, outer.x_upper, outer.y_lower, outer.y_upper});
  }
  if (std::isfinite(bounds.y_lower)) {
    walls.push_back({inner.x_lower, inner.x_upper, outer.y_lower, inner.y_lower});
  }
  if (std::isfinite(bounds.y_upper)) {
    walls.push_back({inner.x_lower, inner.x_upper, inner.y_upper, outer.y_upper});
  }
  return walls;
}

// Diagonal lines that fill `area` at `height`, where x + y is a multiple of `spacing`.
void append_stripes(const PlanarRectangle& area, double height, double spacing,
                    std::vector<SpacePoint>& ends) {
  const double begin = area.x_lower + area.y_lower;
  const double end = area.x_upper + area.y_upper;
  for (double i = std::floor(begin / spacing) + 1.0; i * spacing < end; ++i) {
    const double sum = i * spacing;
    const double x_first = std::max(area.x_lower, sum - area.y_upper);
    const double x_last = std::min(area.x_upper, sum - area.y_lower);
    ends.push_back({x_first, sum - x_first, height});
    ends.push_back({x_last, sum - x_last, height});
  }
}

double stripe_spacing(const PlanarRectangle& region) {
  const double extent = std::max(region.x_upper - region.x_lower, region.y_upper - region.y_lower);
  return std::max(kStripeSpacing, extent / kMostStripes);
}

// Triangles of three corners each, sorted by distance from the camera.
std::vector<ColouredPoint> nearest_first(const std::vector<ColouredPoint>& corners,
                                         const View& view) {
  std::vector<std::pair<double, std::size_t>> order;
  for (std::size_t i = 0; i + 2 < corners.size(); i += 3) {
    double depth = 0.0;
    for (std::size_t k = i; k < i + 3; ++k) {
      depth += camera_coordinates(view, corners[k].position)[2];
    }
    order.emplace_back(depth, i);
  }
  std::sort(order.begin(), order.end());
  std::vector<ColouredPoint> sorted;
  sorted.reserve(corners.size());
  for (const auto& [depth, i] : order) {
    sorted.insert(sorted.end(), corners.begin() + static_cast<std::ptrdiff_t>(i),
                  corners.begin() + static_cast<std::ptrdiff_t>(i + 3));
  }
  return sorted;
}

void paint_driven_path(const Frame& frame, double scale) {
  if (frame.clearances.size() != frame.driven_path.size()) {
    draw_path(frame.driven_path, kMarkHeight, kPathWidth * scale, palette::kDrivenPath);
    return;
  }
  std::vector<ColouredPoint> points;
  for (std::size_t i = 0; i < frame.driven_path.size(); ++i) {
    points.push_back({{frame.driven_path[i].x, frame.driven_path[i].y, kMarkHeight},
                      clearance_colour(frame.clearances[i])});
  }
  draw_coloured_path(points, kPathWidth * scale);
}

}  // namespace

PlanarRectangle world_region(const World& world) {
  PlanarRectangle region{kInfinity, -kInfinity, kInfinity, -kInfinity};
  const auto include = [&region](double x, double y) {
    if (std::isfinite(x)) {
      region.x_lower = std::min(region.x_lower, x);
      region.x_upper = std::max(region.x_upper, x);
    }
    if (std::isfinite(y)) {
      region.y_lower = std::min(region.y_lower, y);
      region.y_upper = std::max(region.y_upper, y);
    }
  };
  include(world.bounds.x_lower, world.bounds.y_lower);
  include(world.bounds.x_upper, world.bounds.y_upper);
  for (const PlanarRectangle& obstacle : world.obstacles) {
    include(obstacle.x_lower, obstacle.y_lower);
    include(obstacle.x_upper, obstacle.y_upper);
  }
  for (const Prism& prism : world.prisms) {
    for (const PlanarPoint& corner : prism.outline) include(corner.x, corner.y);
  }
  for (const RoadLine& line : world.road) {
    for (const PlanarPoint& point : line.points) include(point.x, point.y);
  }
  for (const PlanarPoint& point : world.waypoints) include(point.x, point.y);
  include(world.target.x - world.target_radius, world.target.y - world.target_radius);
  include(world.target.x + world.target_radius, world.target.y + world.target_radius);
  // A half-plane counts with the nearest point of its edge, unless that is more than kNearEdge
  // extents away.
  const PlanarPoint middle{0.5 * (region.x_lower + region.x_upper),
                           0.5 * (region.y_lower + region.y_upper)};
  const double near =
      kNearEdge * std::max(region.x_upper - region.x_lower, region.y_upper - region.y_lower);
  for (const PlanarHalfPlane& half_plane : world.half_planes) {
    const PlanarPoint edge = nearest_on_edge(half_plane, middle);
    if (std::hypot(edge.x - middle.x, edge.y - middle.y) <= near) include(edge.x, edge.y);
  }
  constexpr double kLeastHalf = 1.0;  // m
  const double x = 0.5 * (region.x_lower + region.x_upper);
  const double y = 0.5 * (region.y_lower + region.y_upper);
  return {std::min(region.x_lower, x - kLeastHalf), std::max(region.x_upper, x + kLeastHalf),
          std::min(region.y_lower, y - kLeastHalf), std::max(region.y_upper, y + kLeastHalf)};
}

ScenePainter::ScenePainter(World world, const PlanarRectangle& region)
    : world_(std::move(world)),
      region_(region),
      ground_(grown(region, kGroundReach)),
      walls_(boundary_walls(world_.bounds, region)) {
  // A side may be infinite: a drawn box ends at the edge of the ground.
  for (PlanarRectangle& obstacle : world_.obstacles) obstacle = clipped_to(obstacle, ground_);
  for (const PlanarHalfPlane& half_plane : world_.half_planes) {
    const PlanarOutline part = clipped_to(corners_of(ground_), half_plane);
    world_.prisms.push_back({.outline = part, .pieces = {part}});
  }
  for (Prism& prism : world_.prisms) prism = clipped_to(prism, ground_);
}

void ScenePainter::paint_solids(const std::vector<Prism>& moving) const {
  for (const PlanarRectangle& o : world_.obstacles) {
    draw_box(o, kObstacleHeight, palette::kObstacle);
  }
  for (const Prism& prism : world_.prisms) {
    draw_prism(prism, kObstacleHeight, palette::kObstacle);
  }
  for (const Prism& prism : moving) {
    draw_prism(prism, kObstacleHeight, palette::kMovingObstacle);
  }
  for (const PlanarRectangle& wall : walls_) {
    draw_box(wall, kWallHeight, palette::kWall);
  }
}

// Painted after the ground: smooth lines blend with the background.
void ScenePainter::paint_edges(const std::vector<Prism>& moving, double scale) const {
  for (const PlanarRectangle& o : world_.obstacles) {
    const double z = kObstacleHeight + kEdgeClearance;
    const SpacePoint a{o.x_lower, o.y_lower, z};
    const SpacePoint b{o.x_upper, o.y_lower, z};
    const SpacePoint c{o.x_upper, o.y_upper, z};
    const SpacePoint d{o.x_lower, o.y_upper, z};
    draw_segments({a, b, b, c, c, d, d, a}, kEdgeWidth * scale, palette::kUnsafeEdge);
  }
  for (const std::vector<Prism>* prisms : {&world_.prisms, &moving}) {
    for (const Prism& prism : *prisms) {
      PlanarOutline edge = prism.outline;
      if (!edge.empty()) edge.push_back(edge.front());
      draw_path(edge, kObstacleHeight + kEdgeClearance, kEdgeWidth * scale, palette::kUnsafeEdge);
    }
  }
}

// Unsafe areas are striped: tops of obstacles, and the ground outside the bounds.
void ScenePainter::paint_stripes(const std::vector<Prism>& moving, double scale) const {
  std::vector<SpacePoint> ends;
  for (const PlanarRectangle& obstacle : world_.obstacles) {
    const PlanarRectangle top = clipped_to(obstacle, grown(region_, kGridReach));
    append_stripes(top, kObstacleHeight + kEdgeClearance, stripe_spacing(region_), ends);
  }
  for (const std::vector<Prism>* prisms : {&world_.prisms, &moving}) {
    for (const Prism& prism : *prisms) {
      append_stripes(clipped_to(prism.outline, grown(region_, kGridReach)),
                     kObstacleHeight + kEdgeClearance, stripe_spacing(region_), ends);
    }
  }
  draw_segments(ends, kEdgeWidth * scale, palette::kUnsafeStripe);
}

void ScenePainter::paint_ground(const View& view) const {
  // A camera may be somewhat outside the region; there must be ground about it as well.
  draw_sky(view, 0.5 * kGroundReach, palette::kSky, palette::kHorizon);
  const Fog fog{kFogBegin * view.distance, kFogEnd * view.distance, palette::kHorizon};
  const PlanarRectangle all = grown(region_, kGroundReach);
  const PlanarRectangle safe = clipped_to(world_.bounds, all);
  draw_ground_around(view, safe, all, palette::kOuterGround, fog);
  std::vector<SpacePoint> stripes;
  append_stripes(grown(region_, kStripedReach), 0.0, stripe_spacing(region_), stripes);
  draw_fading_segments(view, stripes, 1.0, palette::kOuterStripe, fog);
  draw_ground(view, safe, palette::kSafeGround, fog);
  draw_fading_segments(view, grid_lines(region_), 1.0, palette::kGridLine, fog);
}

void ScenePainter::paint_shadows(
    const std::vector<Prism>& moving,
    const std::vector<std::vector<PlanarPoint>>& vehicle_shadows) const {
  begin_single_coverage();
  for (const PlanarRectangle& obstacle : world_.obstacles) {
    draw_polygon(box_shadow(obstacle, kObstacleHeight), palette::kShadow);
  }
  for (const std::vector<Prism>* prisms : {&world_.prisms, &moving}) {
    for (const Prism& prism : *prisms) {
      for (const PlanarOutline& piece : prism.pieces) {
        draw_polygon(prism_shadow(piece, kObstacleHeight), palette::kShadow);
      }
    }
  }
  for (const PlanarRectangle& wall : walls_) {
    draw_polygon(box_shadow(wall, kWallHeight), palette::kShadow);
  }
  for (const std::vector<PlanarPoint>& outline : vehicle_shadows) {
    draw_polygon(outline, palette::kShadow);
  }
  end_single_coverage();
}

void ScenePainter::paint_road(double scale) const {
  for (const RoadLine& line : world_.road) {
    const double width = (line.is_edge ? kRoadEdgeWidth : kRoadMiddleWidth) * scale;
    draw_path(line.points, kMarkHeight, width,
              line.is_edge ? palette::kUnsafeEdge : palette::kGridLine);
  }
}

void ScenePainter::paint_target_mark() const {
  const double radius = world_.target_radius;
  draw_ring(world_.target, 0.0, radius, palette::kTarget.with_alpha(0.22F));
  draw_ring(world_.target, 0.93 * radius, radius, palette::kTarget.with_alpha(0.9F));
  draw_ring(world_.target, 0.46 * radius, 0.50 * radius, palette::kTarget.with_alpha(0.55F));
}

/// The next waypoint is drawn like the target, later ones as rings, and those passed faintly.
void ScenePainter::paint_waypoints(std::size_t passed) const {
  const double radius = world_.waypoint_radius;
  for (std::size_t i = 0; i < world_.waypoints.size(); ++i) {
    const PlanarPoint& at = world_.waypoints[i];
    if (i == passed) draw_ring(at, 0.0, radius, palette::kTarget.with_alpha(0.22F));
    const float strength = i < passed ? 0.25F : 0.8F;
    draw_ring(at, 0.93 * radius, radius, palette::kTarget.with_alpha(strength));
  }
}

void ScenePainter::paint_target_post() const {
  const PlanarPoint& t = world_.target;
  write_depth(true);
  draw_box(grown({t.x, t.x, t.y, t.y}, kPostSide), kPostHeight, {0.93F, 0.94F, 0.95F});
  draw_triangle({t.x, t.y, kPostHeight}, {t.x, t.y, 0.68 * kPostHeight},
                {t.x + 0.26, t.y - 0.26, 0.84 * kPostHeight}, palette::kTarget);
  write_depth(false);
  draw_tube(t, world_.target_radius, kTubeHeight, palette::kTarget.with_alpha(0.30F),
            palette::kTarget.with_alpha(0.0F));
}

// Marks on the ground are painted in order and without writing depth, so that none flickers through
// another; upright objects have depth and hide them.
void ScenePainter::paint(const Frame& frame, const View& view, const VehicleMarks& vehicle) const {
  const FlatDrawing drawing(view);
  const double scale = view.height / kReferenceHeight;
  std::vector<Prism> moving;
  for (const Prism& prism : frame.moving) moving.push_back(clipped_to(prism, ground_));
  write_depth(true);
  paint_solids(moving);
  write_depth(false);
  paint_ground(view);
  paint_road(scale);
  paint_waypoints(frame.waypoints_passed);
  paint_target_mark();
  paint_shadows(moving, vehicle.shadows);
  paint_driven_path(frame, scale);
  paint_belief(frame, view, vehicle.length);
  for (const std::vector<PlanarPoint>& line : frame.body) {
    draw_path(line, kMarkHeight, kBodyCasing * scale, palette::kBodyCasing);
  }
  for (const std::vector<PlanarPoint>& line : frame.body) {
    draw_path(line, kMarkHeight, kBodyWidth * scale, palette::kBody);
  }
  paint_stripes(moving, scale);
  paint_edges(moving, scale);
  paint_target_post();
  // The vehicle is neither tinted by the ghost nor hidden by objects in front of it.
  begin_beside(vehicle.surface);
  draw_hidden(nearest_first(vehicle.surface, view));
  draw_translucent(vehicle.ghost);
  end_beside();
}

}  // namespace qsmpc::render
