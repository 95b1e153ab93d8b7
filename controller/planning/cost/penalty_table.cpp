#include "controller/planning/cost/penalty_table.hpp"

#include <cmath>

namespace qsmpc::controller {
namespace {

std::vector<PenaltyTable::Face> bounded_axes(const Box& box) {
  std::vector<PenaltyTable::Face> faces;
  for (Eigen::Index axis = 0; axis < box.lower.size(); ++axis) {
    if (std::isinf(box.lower[axis]) && std::isinf(box.upper[axis])) continue;
    faces.push_back({static_cast<int>(axis), box.lower[axis], box.upper[axis]});
  }
  return faces;
}

}  // namespace

PenaltyTable::PenaltyTable(const SafeSet& safe_set, const Penalty& chosen)
    : penalty(chosen), bounds(bounded_axes(safe_set.bounds)) {
  for (const Box& obstacle : safe_set.obstacles) obstacles.push_back(bounded_axes(obstacle));
}

}  // namespace qsmpc::controller
