#include "controller/measure/quantisation/normal_quantiser.hpp"

#include <array>
#include <cmath>
#include <map>
#include <mutex>
#include <numbers>
#include <stdexcept>

#include <boost/math/special_functions/erf.hpp>

#include "controller/measure/normal/normal_distribution.hpp"
#include "models/constants.hpp"

namespace qsmpc::controller {
namespace {
constexpr int kNewtonLimit = 100;
constexpr int kHalvingLimit = 60;
constexpr double kStepTolerance = 1e-14;
constexpr double kNearby = 1e-6;

double quantile(double probability) {
  return -std::numbers::sqrt2 * boost::math::erfc_inv(2.0 * probability);
}

/// Nearly optimal points: quantiles of the normalised cube root of the density, which is N(0, 3);
/// with these plotting positions even the outermost ones are within 5 % of the solution.
Eigen::VectorXd companded_points(int count) {
  Eigen::VectorXd points(count);
  for (int i = 0; i < count; ++i) {
    points[i] = std::numbers::sqrt3 * quantile((i + 1.0) / (count + 1.0));
  }
  return points;
}

/// Cell edges: midpoints, with infinite ends (count + 1).
Eigen::VectorXd midpoints(const Eigen::VectorXd& points) {
  const Eigen::Index count = points.size();
  Eigen::VectorXd edges(count + 1);
  edges[0] = -kInfinity;
  edges[count] = kInfinity;
  edges.segment(1, count - 1) = 0.5 * (points.head(count - 1) + points.tail(count - 1));
  return edges;
}

/// One Newton step for a_i p_i − m_i = 0 (half the distortion's gradient), solved by elimination:
/// the Jacobian is tridiagonal, symmetric and diagonally dominant near the solution.
Eigen::VectorXd newton_step(const Eigen::VectorXd& points) {
  const Eigen::Index count = points.size();
  const Eigen::VectorXd edges = midpoints(points);
  Eigen::VectorXd diagonal(count);
  Eigen::VectorXd beside(count);  // entry i couples i and i + 1
  Eigen::VectorXd residual(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const double mass = normal_probability(edges[i], edges[i + 1]);
    const double moment = normal_density(edges[i]) - normal_density(edges[i + 1]);
    residual[i] = points[i] * mass - moment;
    const double left = i > 0 ? 0.25 * normal_density(edges[i]) * (points[i] - points[i - 1]) : 0.0;
    const double right =
        i + 1 < count ? 0.25 * normal_density(edges[i + 1]) * (points[i + 1] - points[i]) : 0.0;
    diagonal[i] = mass - left - right;
    beside[i] = -right;
  }
  for (Eigen::Index i = 1; i < count; ++i) {
    const double factor = beside[i - 1] / diagonal[i - 1];
    diagonal[i] -= factor * beside[i - 1];
    residual[i] -= factor * residual[i - 1];
  }
  Eigen::VectorXd step(count);
  for (Eigen::Index i = count - 1; i >= 0; --i) {
    const double beyond = i + 1 < count ? beside[i] * step[i + 1] : 0.0;
    step[i] = (residual[i] - beyond) / diagonal[i];
  }
  return step;
}

bool increasing(const Eigen::VectorXd& points) {
  return points.size() < 2 ||
         (points.tail(points.size() - 1).array() > points.head(points.size() - 1).array()).all();
}

/// Moves `points` by at most `step`, shortened until they still increase.
Eigen::VectorXd moved(const Eigen::VectorXd& points, Eigen::VectorXd step) {
  for (int halving = 0; halving < kHalvingLimit; ++halving) {
    if (increasing(points - step)) return points - step;
    step *= 0.5;
  }
  throw std::logic_error("normal quantiser: Newton's method broke down");
}

Eigen::VectorXd optimal_points(int count) {
  Eigen::VectorXd points = companded_points(count);
  double last_step = kInfinity;
  for (int iteration = 0; iteration < kNewtonLimit; ++iteration) {
    const Eigen::VectorXd step = newton_step(points);
    points = moved(points, step);
    points = (0.5 * (points - points.reverse())).eval();  // the solution is symmetric
    // Near the solution steps shrink quadratically, until rounding stops them.
    const double length = step.cwiseAbs().maxCoeff();
    if (length < kStepTolerance || (length < kNearby && length > 0.5 * last_step)) break;
    last_step = length;
  }
  return points;
}

NormalQuantiser make_quantiser(int count) {
  NormalQuantiser quantiser;
  quantiser.points = optimal_points(count);
  quantiser.weights.resize(count);
  const Eigen::VectorXd edges = midpoints(quantiser.points);
  quantiser.distortion = 0.0;
  for (int i = 0; i < count; ++i) {
    // Mass, first and second moment of the cell; W2² = Σ (s − 2am + a²p), exact on Voronoi cells.
    const double mass = normal_probability(edges[i], edges[i + 1]);
    const double first = normal_density(edges[i]) - normal_density(edges[i + 1]);
    const double second =
        mass + normal_density_moment(edges[i]) - normal_density_moment(edges[i + 1]);
    const double point = quantiser.points[i];
    quantiser.weights[i] = mass;
    quantiser.distortion += second - 2.0 * point * first + point * point * mass;
  }
  return quantiser;
}

}  // namespace

const NormalQuantiser& normal_quantiser(int count) {
  if (count < 1) throw std::invalid_argument("normal quantiser: at least one point is needed");
  static std::mutex mutex;
  static std::map<int, NormalQuantiser> remembered;  // nodes keep their address
  const std::lock_guard lock(mutex);
  const auto found = remembered.find(count);
  if (found != remembered.end()) return found->second;
  return remembered.emplace(count, make_quantiser(count)).first->second;
}

double approximate_distortion(int count) {
  static const std::array<double, kExactDistortions + 1> table = [] {
    std::array<double, kExactDistortions + 1> exact{};
    exact[0] = kInfinity;
    for (int n = 1; n <= kExactDistortions; ++n) exact[n] = make_quantiser(n).distortion;
    return exact;
  }();
  if (count <= kExactDistortions) return table.at(count);
  const double ratio = static_cast<double>(kExactDistortions) / count;
  return table.back() * ratio * ratio;
}

}  // namespace qsmpc::controller
