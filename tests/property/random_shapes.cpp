#include "tests/property/random_shapes.hpp"

#include <cmath>
#include <initializer_list>
#include <memory>
#include <utility>

#include "controller/reference/road_edges.hpp"
#include "controller/surroundings/motion_filter.hpp"
#include "tests/property/random_draws.hpp"

namespace qsmpc::testing {
namespace {

Eigen::Matrix2Xd corners_of(std::initializer_list<Eigen::Vector2d> points) {
  Eigen::Matrix2Xd corners(2, static_cast<Eigen::Index>(points.size()));
  Eigen::Index i = 0;
  for (const Eigen::Vector2d& point : points) corners.col(i++) = point;
  return corners;
}

/// A polygon inscribed in the unit circle, hence convex.
Eigen::Matrix2Xd random_convex(Generator& generator) {
  const int count = uniform_int(generator, 3, 7);
  Eigen::Matrix2Xd corners(2, count);
  const double first = uniform(generator, 0.0, 6.0);
  for (int i = 0; i < count; ++i) {
    const double angle = first + (i + uniform(generator, 0.0, 0.7)) * 6.28 / count;
    corners.col(i) << std::cos(angle), std::sin(angle);
  }
  return corners;
}

/// Of a size between a tenth of `spread` and twice `spread`.
controller::PlanarShape random_shape(Generator& generator, const std::string& kind,
                                     const Eigen::Vector2d& centre, const Eigen::Vector2d& spread) {
  const double size = spread.mean();
  const double angle = uniform(generator, -3.2, 3.2);
  const Eigen::Vector2d half = size * uniform_vector(generator, 2, 0.1, 2.0);
  if (kind == "disc") return controller::DiscShape{.centre = centre, .radius = half.x()};
  if (kind == "ellipse") {
    return controller::EllipseShape{.centre = centre, .semi_axes = half, .angle = angle};
  }
  if (kind == "box") {
    return controller::TurnedBoxShape{.centre = centre, .size = 2.0 * half, .angle = angle};
  }
  if (kind == "half_plane") {
    const Eigen::Vector2d normal(std::cos(angle), std::sin(angle));
    return controller::HalfPlaneShape{.normal = 2.0 * normal, .offset = 2.0 * normal.dot(centre)};
  }
  Eigen::Matrix2Xd corners =
      kind == "polygon"
          ? random_convex(generator)
          : corners_of(
                {{-1.0, -1.0}, {1.0, -1.0}, {1.0, -0.3}, {-0.2, -0.2}, {-0.3, 1.0}, {-1.0, 1.0}});
  corners = (half.asDiagonal() * corners).colwise() + centre;
  return controller::PolygonShape{.corners = corners};
}

/// A winding road, 3 to 10 times `size` wide, around a place beside the path.
std::shared_ptr<const controller::RoadWalls> random_road(Generator& generator,
                                                         const Eigen::Vector2d& about,
                                                         double size) {
  constexpr int kPoints = 9;
  while (true) {
    Eigen::Matrix2Xd points(2, kPoints);
    double heading = uniform(generator, -3.0, 3.0);
    Eigen::Vector2d place = Eigen::Vector2d::Zero();
    for (int i = 0; i < kPoints; ++i) {
      points.col(i) = place;
      heading += uniform(generator, -0.6, 0.6);
      place += 4.0 * size * Eigen::Vector2d(std::cos(heading), std::sin(heading));
    }
    const Eigen::Vector2d middle = points.col(kPoints / 2);
    points.colwise() += about - middle;
    const controller::ArcPath centre(points, false);
    const controller::RoadWidths widths{
        .right = uniform_vector(generator, kPoints, 1.5 * size, 5.0 * size),
        .left = uniform_vector(generator, kPoints, 1.5 * size, 5.0 * size)};
    if (controller::folded_edge(centre, widths)) continue;
    controller::RoadEdges edges = controller::edges_about(centre, widths, 6.0 * size);
    if (controller::where_edges_meet(edges)) continue;
    return std::make_shared<const controller::RoadWalls>(std::move(edges));
  }
}

/// A way that covers about `reach` within `duration` and never stands still.
models::IntendedWay random_way(Generator& generator, const Eigen::Vector2d& from, double reach,
                               double duration) {
  const auto velocity = [&]() -> Eigen::Vector2d {
    const double angle = uniform(generator, -3.2, 3.2);
    return reach / duration * uniform(generator, 0.3, 1.5) *
           Eigen::Vector2d(std::cos(angle), std::sin(angle));
  };
  models::IntendedWay way = models::steady_way(velocity(), from);
  if (chance(generator, 0.5)) return way;
  for (int i = 0; i < 3; ++i) {
    const models::TimedPlace& last = way.points.back();
    const double time = uniform(generator, 0.2, 0.6) * duration;
    way.points.push_back({.time = last.time + time, .place = last.place + time * velocity()});
  }
  return way;
}

models::ObstacleMotion random_motion(Generator& generator, const Eigen::Vector2d& from,
                                     double reach, double duration) {
  models::ObstacleMotion motion{.ways = {}, .seen_deviation = 0.1 * reach};
  const int count = chance(generator, 0.5) ? 1 : uniform_int(generator, 2, 3);
  for (int i = 0; i < count; ++i) {
    motion.ways.push_back(random_way(generator, from, reach, duration));
    motion.ways.back().probability = 1.0 / count;
  }
  if (chance(generator, 0.15)) {
    motion.ways.resize(1);  // a certain way
    motion.ways.front().probability = 1.0;
    return motion;
  }
  if (chance(generator, 0.5))
    motion.start_deviation = reach * uniform_vector(generator, 2, 0.0, 1.0);
  motion.speed_deviation = reach / duration * uniform_vector(generator, 2, 0.0, 1.0);
  motion.memory = duration * uniform(generator, 0.1, 3.0);
  if (chance(generator, 0.5)) motion.returns_in = duration * uniform_vector(generator, 2, 0.1, 2.0);
  if (chance(generator, 0.5)) {
    motion.covariance_rate = reach * reach / duration * uniform_vector(generator, 2, 0.0, 0.5);
  }
  motion.turns = chance(generator, 0.5);
  return motion;
}

}  // namespace

controller::SafeSet random_shapes(Generator& generator, const std::string& kind,
                                  const Eigen::MatrixXd& path, const Eigen::VectorXd& spread) {
  controller::SafeSet safe_set = controller::unbounded_safe_set(path.rows());
  if (kind == "road") {
    const Eigen::Vector2d beside =
        path.col(uniform_int(generator, 0, static_cast<int>(path.cols()) - 1)).head<2>();
    const double size = spread.head<2>().maxCoeff();
    safe_set.road =
        random_road(generator, beside + size * uniform_vector(generator, 2, -2.0, 2.0), size);
    return safe_set;
  }
  const int count = kind == "half_plane" ? 1 : uniform_int(generator, 1, 4);
  for (int i = 0; i < count; ++i) {
    const Eigen::Vector2d beside =
        path.col(uniform_int(generator, 0, static_cast<int>(path.cols()) - 1)).head<2>();
    const Eigen::Vector2d away =
        uniform_vector(generator, 2, -4.0, 4.0).cwiseProduct(spread.head<2>());
    safe_set.obstacles.emplace_back(random_shape(generator, kind, beside + away, spread.head<2>()));
  }
  return safe_set;
}

void set_in_motion(Generator& generator, const Eigen::VectorXd& spread, int horizon,
                   controller::SafeSet& safe_set) {
  auto forecast = std::make_shared<controller::ObstacleForecast>(safe_set.obstacles.size());
  for (std::size_t n = 0; n < safe_set.obstacles.size(); ++n) {
    controller::Obstacle& obstacle = safe_set.obstacles[n];
    const double reach = spread.head<2>().mean() * uniform(generator, 0.2, 2.0);
    obstacle.motion = random_motion(generator, controller::shape_centre(*obstacle.shape()), reach,
                                    horizon * kObstaclePeriod);
    forecast->set(n, controller::MotionFilter(*obstacle.motion, kObstaclePeriod).forecast(horizon));
  }
  safe_set.forecast = std::move(forecast);
}

}  // namespace qsmpc::testing
