#include "tests/property/random_problem.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <utility>

#include "controller/reference/road_edges.hpp"
#include "controller/surroundings/motion_filter.hpp"
#include "models/constants.hpp"
#include "tests/support/own_systems.hpp"

namespace qsmpc::testing {

double uniform(Generator& generator, double lower, double upper) {
  return std::uniform_real_distribution<double>(lower, upper)(generator);
}

namespace {

constexpr double kTimeStep = 0.1;  // s

int uniform_int(Generator& generator, int lower, int upper) {
  return std::uniform_int_distribution<int>(lower, upper)(generator);
}

bool chance(Generator& generator, double probability) {
  return uniform(generator, 0.0, 1.0) < probability;
}

/// Between 10^low and 10^high, uniform in the logarithm.
double log_uniform(Generator& generator, double low, double high) {
  return std::pow(10.0, uniform(generator, low, high));
}

Eigen::VectorXd uniform_vector(Generator& generator, Eigen::Index size, double lower,
                               double upper) {
  return Eigen::VectorXd::NullaryExpr(size, [&] { return uniform(generator, lower, upper); });
}

/// Correlated, with deviations between 10^low and 10^high; sometimes one coordinate is exactly
/// known.
Eigen::MatrixXd random_covariance(Generator& generator, Eigen::Index dim, double low, double high) {
  const Eigen::MatrixXd root =
      Eigen::MatrixXd::NullaryExpr(dim, dim, [&] { return uniform(generator, -1.0, 1.0); });
  Eigen::MatrixXd covariance = root * root.transpose() + 0.05 * Eigen::MatrixXd::Identity(dim, dim);
  if (chance(generator, 0.3)) {
    const Eigen::VectorXd diagonal = covariance.diagonal();
    covariance = diagonal.asDiagonal();
  }
  Eigen::VectorXd scale =
      Eigen::VectorXd::NullaryExpr(dim, [&] { return log_uniform(generator, low, high); });
  if (chance(generator, 0.1)) {
    scale[uniform_int(generator, 0, static_cast<int>(dim) - 1)] = 0.0;
  }
  const Eigen::VectorXd factor = scale.cwiseQuotient(covariance.diagonal().cwiseSqrt());
  covariance = (factor.asDiagonal() * covariance * factor.asDiagonal()).eval();
  return 0.5 * (covariance + covariance.transpose());
}

/// What is specific to a system: its initial states, and the coordinates with walls.
struct Family {
  std::string system;
  models::ParameterMap parameters;
  Eigen::VectorXd start;
  std::vector<Eigen::Index> walls;  ///< the first two are those of the obstacles
  double largest_deviation = 0.3;   ///< of the belief
};

Family random_family(Generator& generator) {
  const double which = uniform(generator, 0.0, 1.0);
  if (which < 0.55) {
    return {.system = which < 0.35 ? "dubins" : "dubins_rk4",
            .parameters = {{"speed", uniform(generator, 0.5, 3.0)}},
            .start = uniform_vector(generator, 3, -2.0, 2.0),
            .walls = {0, 1, 2}};
  }
  if (which < 0.8) {
    Eigen::VectorXd start = uniform_vector(generator, 6, -0.3, 0.3);
    start[3] = uniform(generator, 3.0, 12.0);
    return {.system = "bicycle",
            .parameters = {},
            .start = start,
            .walls = {0, 1, 2},
            .largest_deviation = 0.2};
  }
  if (which < 0.9) {
    return {.system = "double_integrator",
            .parameters = {},
            .start = uniform_vector(generator, 2, -1.0, 1.0),
            .walls = {0, 1}};
  }
  if (which < 0.95) {
    return {.system = "point_mass",
            .parameters = {{"damping", uniform(generator, 0.0, 2.0)}},
            .start = uniform_vector(generator, 4, -1.0, 1.0),
            .walls = {0, 1}};
  }
  Eigen::VectorXd start = uniform_vector(generator, 4, -0.3, 0.3);
  return {.system = "cart_pole",
          .parameters = {{"cart_damping", uniform(generator, 0.0, 2.0)},
                         {"pole_damping", uniform(generator, 0.0, 0.1)}},
          .start = start,
          .walls = {0, 2},
          .largest_deviation = 0.2};
}

controller::Box everywhere(Eigen::Index dim) {
  return {.lower = Eigen::VectorXd::Constant(dim, -kInfinity),
          .upper = Eigen::VectorXd::Constant(dim, kInfinity)};
}

/// Bounds just beyond the extent of `path`, some of them omitted, and obstacles beside it; all
/// scaled by `spread`, roughly the deviation of the state from the path.
controller::SafeSet random_safe_set(Generator& generator, const Family& family,
                                    const Eigen::MatrixXd& path, const Eigen::VectorXd& spread) {
  controller::SafeSet safe_set = controller::unbounded_safe_set(path.rows());
  for (const Eigen::Index axis : family.walls) {
    const double likely = axis == 2 ? 0.2 : 0.6;
    const double least = path.row(axis).minCoeff();
    const double most = path.row(axis).maxCoeff();
    const double low = least - uniform(generator, 0.5, 4.0) * spread[axis];
    const double high = most + uniform(generator, 0.5, 4.0) * spread[axis];
    if (chance(generator, likely)) safe_set.bounds.lower[axis] = low;
    if (chance(generator, likely)) safe_set.bounds.upper[axis] = high;
  }
  const int obstacles = uniform_int(generator, 0, 5);
  for (int i = 0; i < obstacles; ++i) {
    const Eigen::VectorXd beside =
        path.col(uniform_int(generator, 0, static_cast<int>(path.cols()) - 1));
    controller::Box box = everywhere(path.rows());
    for (std::size_t k = 0; k < family.walls.size(); ++k) {
      if (k == 2 && !chance(generator, 0.3)) continue;
      const Eigen::Index axis = family.walls[k];
      const double centre = beside[axis] + uniform(generator, -5.0, 5.0) * spread[axis];
      const double half = uniform(generator, 0.1, 2.0) * spread[axis];
      box.lower[axis] = centre - half;
      box.upper[axis] = centre + half;
    }
    safe_set.obstacles.push_back(box);
  }
  return safe_set;
}

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

/// Makes the shapes move, about as far as they are away from the path.
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

/// Up to four discs of the size of `spread`, or a point; the discs are off the position if the
/// system has a heading.
controller::Body random_body(Generator& generator, const Family& family,
                             const Eigen::VectorXd& spread) {
  const bool plane = family.walls.size() == 3;
  controller::Body body{.discs = {}, .x = 0, .y = plane ? 1 : -1, .heading = plane ? 2 : -1};
  const int count = chance(generator, 0.5) ? uniform_int(generator, 1, 4) : 0;
  for (int i = 0; i < count; ++i) {
    controller::Disc disc{.radius = uniform(generator, 0.0, 2.0) * spread[0]};
    if (plane && chance(generator, 0.8)) {
      disc.offset = 5.0 * spread[0] * uniform_vector(generator, 2, -1.0, 1.0);
    }
    body.discs.push_back(disc);
  }
  return body;
}

/// The propagator and its points; few points where each is expensive.
void random_propagation(Generator& generator, controller::PlannerSettings& settings) {
  const double which = uniform(generator, 0.0, 1.0);
  settings.propagator = which < 0.35   ? "mixture"
                        : which < 0.55 ? "compressed"
                        : which < 0.75 ? "noise_free"
                        : which < 0.9  ? "soft"
                                       : "moment_matched";
  const int most = which < 0.75 ? 200 : 25;
  settings.state_points = uniform_int(generator, 10, most);
  settings.noise_points = uniform_int(generator, 10, most);
  settings.compressed_points = uniform_int(generator, 10, most);
}

void random_policy(Generator& generator, Problem& problem) {
  controller::PlannerSettings& settings = problem.settings;
  const int dim = problem.dynamics->state_dim();
  const int inputs = problem.dynamics->input_dim();
  settings.closed_loop = chance(generator, 0.5);
  if (settings.closed_loop && chance(generator, 0.5)) {
    settings.feedback_gain =
        Eigen::MatrixXd::NullaryExpr(inputs, dim, [&] { return uniform(generator, -3.0, 3.0); });
  }
  const models::SystemDescription& description = problem.dynamics->description();
  const double share = uniform(generator, 0.1, 1.0);
  settings.bounds = {.lower = share * description.input_lower,
                     .upper = share * description.input_upper};
  settings.cost = {.state = Eigen::MatrixXd::Identity(dim, dim),
                   .input = 0.1 * Eigen::MatrixXd::Identity(inputs, inputs),
                   .terminal = Eigen::MatrixXd::Identity(dim, dim),
                   .target = problem.belief.mean + uniform_vector(generator, dim, -1.0, 1.0)};
}

}  // namespace

namespace {

/// shapes: if given, obstacles are of this kind, and may move.
Problem random_problem_of(Generator& generator, const Family& family,
                          std::unique_ptr<const models::Dynamics> dynamics,
                          const std::string& shapes = "", bool move = false) {
  const Eigen::Index dim = family.start.size();
  Problem problem;
  problem.system = family.system;
  problem.dynamics = std::move(dynamics);
  problem.belief = {
      .mean = family.start,
      .covariance = random_covariance(generator, dim, -2.5, std::log10(family.largest_deviation))};
  controller::PlannerSettings& settings = problem.settings;
  settings.horizon = uniform_int(generator, 1, 8);
  random_policy(generator, problem);
  random_propagation(generator, settings);
  settings.max_evaluations = chance(generator, 0.5) ? 1 : 10;
  settings.noise_covariance = random_covariance(generator, dim, -3.0, -1.0);
  Eigen::VectorXd input = settings.bounds.lower;
  const double share = uniform(generator, 0.0, 1.0);
  input += share * (settings.bounds.upper - settings.bounds.lower);
  const Eigen::MatrixXd path = controller::nominal_states(*problem.dynamics, problem.belief.mean,
                                                          input.replicate(1, settings.horizon));
  const Eigen::VectorXd spread = (problem.belief.covariance.diagonal() +
                                  0.5 * settings.horizon * settings.noise_covariance.diagonal())
                                     .cwiseSqrt()
                                     .cwiseMax(0.01);
  settings.safe_set = shapes.empty() ? random_safe_set(generator, family, path, spread)
                                     : random_shapes(generator, shapes, path, spread);
  if (move) set_in_motion(generator, spread, settings.horizon, settings.safe_set);
  settings.safe_set.body = random_body(generator, family, spread);
  if (chance(generator, 0.3)) settings.risk.plan = log_uniform(generator, -3.0, -0.3);
  return problem;
}

/// One of the two systems, by equations or in C++.
Family random_own_family(Generator& generator) {
  const std::string how = chance(generator, 0.5) ? "" : "_by_equations";
  if (chance(generator, 0.5)) {
    Eigen::VectorXd start = uniform_vector(generator, 5, -0.5, 0.5);
    start[3] = uniform(generator, 0.3, 2.0);
    return {.system = "lag_unicycle" + how,
            .parameters = {},
            .start = start,
            .walls = {0, 1, 2},
            .largest_deviation = 0.2};
  }
  return {.system = "planar_quadrotor" + how,
          .parameters = {},
          .start = uniform_vector(generator, 6, -0.3, 0.3),
          .walls = {0, 1},
          .largest_deviation = 0.2};
}

}  // namespace

Problem random_problem(Generator& generator) {
  const Family family = random_family(generator);
  return random_problem_of(generator, family,
                           models::make_dynamics(family.system, family.parameters, kTimeStep));
}

const std::vector<std::string>& shape_kinds() {
  static const std::vector<std::string> kinds = {"disc",   "ellipse",    "box", "polygon",
                                                 "corner", "half_plane", "road"};
  return kinds;
}

namespace {

Problem random_planar_problem(Generator& generator, const std::string& kind, bool move) {
  Family family;
  do family = random_family(generator);
  while (family.walls.size() < 3);  // families with a plane
  return random_problem_of(generator, family,
                           models::make_dynamics(family.system, family.parameters, kTimeStep), kind,
                           move);
}

}  // namespace

Problem random_shape_problem(Generator& generator, const std::string& kind) {
  return random_planar_problem(generator, kind, false);
}

Problem random_moving_problem(Generator& generator, const std::string& kind) {
  return random_planar_problem(generator, kind, true);
}

Problem random_own_problem(Generator& generator) {
  const Family family = random_own_family(generator);
  return random_problem_of(generator, family, make_any_dynamics(family.system, kTimeStep));
}

}  // namespace qsmpc::testing
