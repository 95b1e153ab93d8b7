#include "tests/property/random_problem.hpp"

#include <utility>

#include "models/constants.hpp"
#include "tests/property/random_draws.hpp"
#include "tests/property/random_shapes.hpp"
#include "tests/support/own_systems.hpp"

namespace qsmpc::testing {
namespace {

constexpr double kTimeStep = 0.1;  // s

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
