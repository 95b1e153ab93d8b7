#include "controller/reference/waypoints.hpp"

#include <algorithm>
#include <cmath>

namespace qsmpc::controller {
namespace {

double distance(const models::SystemDescription& system, const Eigen::Ref<const Eigen::VectorXd>& a,
                const Eigen::Ref<const Eigen::VectorXd>& b) {
  return std::hypot(a[system.position_x] - b[system.position_x],
                    a[system.position_y] - b[system.position_y]);
}

}  // namespace

int waypoints_passed(const Waypoints& route, const models::SystemDescription& system,
                     const Eigen::Ref<const Eigen::VectorXd>& state, int before) {
  int passed = before;
  while (passed + 1 < route.count() &&
         distance(system, route.states.col(passed), state) <= route.radius) {
    ++passed;
  }
  return passed;
}

double way_over(const Waypoints& route, const models::SystemDescription& system,
                const Eigen::Ref<const Eigen::VectorXd>& state, double passed) {
  const auto first = std::min(static_cast<Eigen::Index>(passed), route.states.cols() - 1);
  double way = distance(system, route.states.col(first), state);
  for (Eigen::Index i = first + 1; i < route.states.cols(); ++i) {
    way += distance(system, route.states.col(i - 1), route.states.col(i));
  }
  return way;
}

}  // namespace qsmpc::controller
