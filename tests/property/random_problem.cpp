#include "tests/property/random_problem.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Cholesky>

namespace qsmpc::testing {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kTimeStep = 0.1;  // s
constexpr Eigen::Index kDim = 3;
constexpr Eigen::Index kHeading = 2;

double uniform(Generator& generator, double lower, double upper) {
  return std::uniform_real_distribution<double>(lower, upper)(generator);
}

int uniform_int(Generator& generator, int lower, int upper) {
  return std::uniform_int_distribution<int>(lower, upper)(generator);
}

/// Between 10^low and 10^high, evenly in the logarithm.
double log_uniform(Generator& generator, double low, double high) {
  return std::pow(10.0, uniform(generator, low, high));
}

/// Correlated, with deviations between 10^low and 10^high.
Eigen::MatrixXd random_covariance(Generator& generator, double low, double high) {
  const Eigen::MatrixXd root =
      Eigen::MatrixXd::NullaryExpr(kDim, kDim, [&] { return uniform(generator, -1.0, 1.0); });
  Eigen::MatrixXd covariance = root * root.transpose() + 0.05 * Eigen::MatrixXd::Identity(3, 3);
  const Eigen::VectorXd scale =
      Eigen::VectorXd::NullaryExpr(kDim, [&] { return log_uniform(generator, low, high); });
  const Eigen::VectorXd factor = scale.cwiseQuotient(covariance.diagonal().cwiseSqrt());
  covariance = (factor.asDiagonal() * covariance * factor.asDiagonal()).eval();
  return 0.5 * (covariance + covariance.transpose());
}

Box random_box(Generator& generator, const Eigen::VectorXd& beside) {
  Box box{.lower = Eigen::VectorXd::Constant(kDim, -kInfinity),
          .upper = Eigen::VectorXd::Constant(kDim, kInfinity)};
  for (Eigen::Index axis = 0; axis < 2; ++axis) {
    const double half = uniform(generator, 0.02, 0.3);
    const double centre = beside[axis] + uniform(generator, -0.8, 0.8);
    box.lower[axis] = centre - half;
    box.upper[axis] = centre + half;
  }
  if (uniform(generator, 0.0, 1.0) < 0.3) {
    const double centre = beside[kHeading] + uniform(generator, -0.5, 0.5);
    box.lower[kHeading] = centre - uniform(generator, 0.05, 0.6);
    box.upper[kHeading] = centre + uniform(generator, 0.05, 0.6);
  }
  return box;
}

/// Bounds just beyond the extent of `path`, some of them left out, and obstacles beside it.
SafeSet random_safe_set(Generator& generator, const Eigen::MatrixXd& path) {
  SafeSet safe_set = unbounded_safe_set(kDim);
  for (Eigen::Index axis = 0; axis < kDim; ++axis) {
    const double chance = axis == kHeading ? 0.2 : 0.6;
    if (uniform(generator, 0.0, 1.0) < chance) {
      safe_set.bounds.lower[axis] = path.row(axis).minCoeff() - uniform(generator, 0.05, 0.6);
    }
    if (uniform(generator, 0.0, 1.0) < chance) {
      safe_set.bounds.upper[axis] = path.row(axis).maxCoeff() + uniform(generator, 0.05, 0.6);
    }
  }
  const int obstacles = uniform_int(generator, 0, 5);
  for (int i = 0; i < obstacles; ++i) {
    const int stage = uniform_int(generator, 0, static_cast<int>(path.cols()) - 1);
    safe_set.obstacles.push_back(random_box(generator, path.col(stage)));
  }
  return safe_set;
}

/// Written out once more, so that the truth does not rest on what is tested.
bool inside(const Box& box, const Points& states, Eigen::Index i) {
  for (Eigen::Index axis = 0; axis < kDim; ++axis) {
    if (states(axis, i) < box.lower[axis] || states(axis, i) > box.upper[axis]) return false;
  }
  return true;
}

bool unsafe(const SafeSet& safe_set, const Points& states, Eigen::Index i) {
  return !inside(safe_set.bounds, states, i) ||
         std::any_of(safe_set.obstacles.begin(), safe_set.obstacles.end(),
                     [&](const Box& obstacle) { return inside(obstacle, states, i); });
}

/// Draws of N(0, covariance), one a column.
class NormalDraws {
 public:
  explicit NormalDraws(const Eigen::MatrixXd& covariance) : root_(covariance.llt().matrixL()) {}
  [[nodiscard]] Points operator()(Eigen::Index count, Generator& generator) {
    return root_ * Points::NullaryExpr(kDim, count, [&] { return normal_(generator); });
  }

 private:
  Eigen::MatrixXd root_;
  std::normal_distribution<double> normal_;
};

}  // namespace

Problem random_problem(Generator& generator) {
  Problem problem;
  problem.dynamics = make_dynamics("dubins", {{"speed", uniform(generator, 0.5, 3.0)}}, kTimeStep);
  problem.belief = {
      .mean = Eigen::VectorXd::NullaryExpr(kDim, [&] { return uniform(generator, -2.0, 2.0); }),
      .covariance = random_covariance(generator, -2.5, -0.5)};
  PlannerSettings& settings = problem.settings;
  settings.horizon = uniform_int(generator, 1, 8);
  settings.closed_loop = uniform_int(generator, 0, 1) == 1;
  if (settings.closed_loop && uniform_int(generator, 0, 1) == 1) {
    settings.feedback_gain =
        Eigen::MatrixXd::NullaryExpr(1, kDim, [&] { return uniform(generator, -4.0, 4.0); });
  }
  settings.propagator = uniform_int(generator, 0, 3) == 0 ? "noise_free" : "compressed";
  settings.state_points = uniform_int(generator, 10, 200);
  settings.noise_points = uniform_int(generator, 10, 200);
  settings.compressed_points = uniform_int(generator, 10, 200);
  settings.max_evaluations = uniform_int(generator, 0, 1) == 0 ? 1 : 10;
  settings.noise_covariance = random_covariance(generator, -3.0, -1.0);
  settings.bounds = {.lower = Eigen::VectorXd::Constant(1, -uniform(generator, 0.2, 2.0)),
                     .upper = Eigen::VectorXd::Constant(1, uniform(generator, 0.2, 2.0))};
  settings.cost = {.state = Eigen::MatrixXd::Identity(kDim, kDim),
                   .input = Eigen::MatrixXd::Constant(1, 1, 0.1),
                   .terminal = Eigen::MatrixXd::Identity(kDim, kDim),
                   .target = problem.belief.mean + Eigen::VectorXd::NullaryExpr(kDim, [&] {
                               return uniform(generator, -1.0, 1.0);
                             })};
  const double turn = uniform(generator, settings.bounds.lower[0], settings.bounds.upper[0]);
  const Eigen::MatrixXd path = nominal_states(*problem.dynamics, problem.belief.mean,
                                              Eigen::MatrixXd::Constant(1, settings.horizon, turn));
  settings.safe_set = random_safe_set(generator, path);
  return problem;
}

UnsafeCounts simulate(const Problem& problem, const Policy& policy, int paths,
                      Generator& generator) {
  NormalDraws belief(problem.belief.covariance);
  NormalDraws noise(problem.settings.noise_covariance);
  Points states = belief(paths, generator).colwise() + problem.belief.mean;
  Points inputs(1, paths);
  Points next(kDim, paths);
  UnsafeCounts counts;
  std::vector<bool> ever(paths, false);
  for (Eigen::Index k = 0; k < policy.horizon(); ++k) {
    policy_inputs(policy, k, states, inputs);
    problem.dynamics->step(states, inputs, next);
    states = next + noise(paths, generator);
    counts.stages.push_back(0);
    for (int i = 0; i < paths; ++i) {
      if (!unsafe(problem.settings.safe_set, states, i)) continue;
      ++counts.stages.back();
      ever[i] = true;
    }
  }
  counts.any = static_cast<int>(std::count(ever.begin(), ever.end(), true));
  return counts;
}

}  // namespace qsmpc::testing
