#include "controller/planning/guide/guide.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "controller/planning/policy_maker.hpp"
#include "controller/regions/standing.hpp"
#include "controller/regions/unsafe_set.hpp"

namespace qsmpc::controller {
namespace {

// Number of grid spacings along the longer side of the bounds.
constexpr double kNodes = 160.0;
// Risk allowed to a plan without a risk limit.
constexpr double kUsualRisk = 0.05;
// How much more a straight line may cost than the cheapest way: a factor, plus spacings of the
// grid.
constexpr double kDetour = 1.05;
constexpr double kSlack = 1.0;
// The heading at an aim points towards the node of the way that is this many nodes farther on.
constexpr std::ptrdiff_t kOnwards = 10;

void require_plane(const models::SystemDescription& system, const SafeSet& safe_set) {
  const auto bounded = [&](int axis) {
    return axis >= 0 && std::isfinite(safe_set.bounds.lower[axis]) &&
           std::isfinite(safe_set.bounds.upper[axis]);
  };
  if (!bounded(system.position_x) || !bounded(system.position_y)) {
    throw std::invalid_argument("a guide needs a position in the plane within finite bounds");
  }
}

PlaneGrid grid_over(const Box& bounds, int x, int y) {
  const Eigen::Vector2d size(bounds.upper[x] - bounds.lower[x], bounds.upper[y] - bounds.lower[y]);
  PlaneGrid grid{.origin = {bounds.lower[x], bounds.lower[y]}, .spacing = size.maxCoeff() / kNodes};
  grid.columns = std::max<Eigen::Index>(2, std::lround(std::ceil(size.x() / grid.spacing)) + 1);
  grid.rows = std::max<Eigen::Index>(2, std::lround(std::ceil(size.y() / grid.spacing)) + 1);
  return grid;
}

double allowed_risk(const PlannerSettings& settings) {
  const double stages = static_cast<double>(settings.horizon);
  const double plan = std::min(settings.risk.plan, stages * settings.risk.stage);
  return std::isfinite(plan) && plan > 0.0 ? std::min(plan, 1.0) : kUsualRisk;
}

/// Price of a metre at each node: 1 + horizon · (vehicle's risk at the node) / (risk allowed to a
/// plan).
Eigen::ArrayXXd prices_on(const PlaneGrid& grid, const models::Dynamics& dynamics,
                          const PlannerSettings& settings) {
  const models::SystemDescription& system = dynamics.description();
  // The way is computed once, so only round static obstacles.
  const UnsafeSet unsafe(standing(settings.safe_set));
  double radius = 0.0;
  for (const Disc& disc : settings.safe_set.body.discs) radius = std::max(radius, disc.radius);
  const double deviation =
      std::max(lateral_deviation(dynamics, settings), std::numeric_limits<double>::min());
  const double weight = static_cast<double>(settings.horizon) / allowed_risk(settings);
  const Box& bounds = settings.safe_set.bounds;
  Eigen::VectorXd state = settings.cost.target;
  Eigen::ArrayXXd prices(grid.columns, grid.rows);
  for (Eigen::Index c = 0; c < grid.columns; ++c) {
    for (Eigen::Index r = 0; r < grid.rows; ++r) {
      const Eigen::Vector2d position = grid.node(c, r);
      double clearance = std::numeric_limits<double>::max();
      for (const auto& [axis, at] : {std::pair(system.position_x, position.x()),
                                     std::pair(system.position_y, position.y())}) {
        state[axis] = at;
        clearance = std::min({clearance, at - bounds.lower[axis], bounds.upper[axis] - at});
      }
      for (const RegionPointer& region : unsafe.obstacles()) {
        clearance = std::min(clearance, region->signed_distance(0, state));
      }
      prices(c, r) = 1.0 + weight * std::erfc((clearance - radius) / (deviation * std::sqrt(2.0)));
    }
  }
  return prices;
}

TravelField field_for(const models::Dynamics& dynamics, const PlannerSettings& settings) {
  const models::SystemDescription& system = dynamics.description();
  require_plane(system, settings.safe_set);
  const PlaneGrid grid = grid_over(settings.safe_set.bounds, system.position_x, system.position_y);
  const Eigen::VectorXd& target = settings.cost.target;
  return {grid, prices_on(grid, dynamics, settings),
          Eigen::Vector2d(target[system.position_x], target[system.position_y])};
}

double length_of(const std::vector<Eigen::Vector2d>& way) {
  double length = 0.0;
  for (std::size_t i = 1; i < way.size(); ++i) length += (way[i] - way[i - 1]).norm();
  return length;
}

}  // namespace

double lateral_deviation(const models::Dynamics& dynamics, const PlannerSettings& settings) {
  const Eigen::Index dim = dynamics.state_dim();
  const Eigen::Index inputs = dynamics.input_dim();
  const Eigen::VectorXd neutral =
      Eigen::VectorXd::Zero(inputs).cwiseMax(settings.bounds.lower).cwiseMin(settings.bounds.upper);
  Policy policy;
  PolicyMaker(dynamics, settings)
      .make(settings.cost.target, neutral.replicate(1, settings.horizon),
            Eigen::MatrixXd::Zero(inputs, dim), policy);
  Eigen::MatrixXd noise = settings.noise_covariance;
  if (settings.model_error) {
    noise.diagonal() += settings.model_error->root_mean_square.cwiseAbs2();
  }
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(dim, dim);
  Eigen::MatrixXd by_state(dim, dim);
  Eigen::MatrixXd by_input(dim, inputs);
  for (Eigen::Index k = 0; k < policy.horizon(); ++k) {
    dynamics.jacobians(policy.states.col(k), policy.inputs.col(k), by_state, by_input);
    const Eigen::MatrixXd closed = by_state + by_input * policy.gains[static_cast<std::size_t>(k)];
    covariance = (closed * covariance * closed.transpose() + noise).eval();
  }
  const std::vector<Eigen::Index> axes = {dynamics.description().position_x,
                                          dynamics.description().position_y};
  const Eigen::Matrix2d position = covariance(axes, axes);
  const Eigen::VectorXd moved = policy.states.rightCols<1>() - policy.states.col(0);
  const Eigen::Vector2d across(-moved[axes[1]], moved[axes[0]]);
  const double most = std::sqrt(std::max(0.0, position.trace()));
  if (!(across.norm() > 0.0)) return most;
  const double variance = across.dot(position * across) / across.squaredNorm();
  return std::isfinite(variance) ? std::sqrt(std::max(0.0, variance)) : most;
}

Guide::Guide(const models::Dynamics& dynamics, const PlannerSettings& settings)
    : x_(dynamics.description().position_x),
      y_(dynamics.description().position_y),
      heading_(dynamics.description().heading),
      target_(settings.cost.target),
      field_(field_for(dynamics, settings)) {}

const Aim& Guide::aim(const Eigen::Ref<const Eigen::VectorXd>& state) {
  const Eigen::Vector2d from(state[x_], state[y_]);
  const Eigen::Vector2d goal(target_[x_], target_[y_]);
  field_.trace(from, way_);
  way_.back() = goal;
  aim_.way = length_of(way_);
  aim_.state = target_;

  const double whole = field_.cost(from);
  const double slack = kSlack * field_.grid().spacing;
  std::size_t at = way_.size() - 1;
  for (; at > 0; --at) {
    const double enough = kDetour * (whole - field_.cost(way_[at])) + slack;
    if (field_.cost_of_line(from, way_[at], enough) <= enough) break;
  }
  if (at + 1 == way_.size()) return aim_;
  aim_.state[x_] = way_[at].x();
  aim_.state[y_] = way_[at].y();
  if (heading_ >= 0) {
    const std::size_t onwards = std::min(at + std::size_t{kOnwards}, way_.size() - 1);
    const Eigen::Vector2d along = way_[onwards] - way_[at];
    const double turn = 2.0 * std::numbers::pi;
    const double direction = std::atan2(along.y(), along.x());
    aim_.state[heading_] = direction + turn * std::round((state[heading_] - direction) / turn);
  }
  return aim_;
}

}  // namespace qsmpc::controller
