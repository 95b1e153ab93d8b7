#include "controller/regions/unsafe_set.hpp"

#include <algorithm>

#include "controller/named_entry.hpp"
#include "controller/regions/shapes.hpp"
#include "models/constants.hpp"

namespace qsmpc::controller {

const std::vector<ShapeEntry>& region_shapes() {
  static const std::vector<ShapeEntry> table = {
      {"walls", "everything outside of the intervals", make_walls},
      {"box", "everything inside of the intervals", make_box},
  };
  return table;
}

RegionPointer make_region(std::string_view shape, const Box& intervals) {
  check_box(intervals, intervals.lower.size(), std::string(shape));
  return named_entry(region_shapes(), shape, "shape").make(intervals);
}

UnsafeSet::UnsafeSet(const SafeSet& safe_set) : bounds_(safe_set.bounds) {
  check_safe_set(safe_set);
  regions_.reserve(1 + safe_set.obstacles.size());
  regions_.push_back(make_region("walls", safe_set.bounds));
  for (const Box& obstacle : safe_set.obstacles) regions_.push_back(make_region("box", obstacle));
}

double clearance(const Eigen::Ref<const Eigen::VectorXd>& point, const UnsafeSet& unsafe,
                 Eigen::Index stage) {
  // What is not a number in the first is not lost in the minima.
  double least = unsafe.walls().signed_distance(stage, point);
  for (const RegionPointer& region : unsafe.regions()) {
    least = std::min(least, region->signed_distance(stage, point));
  }
  return least;
}

double distance_to_unsafe(const Eigen::Ref<const Eigen::VectorXd>& point, const UnsafeSet& unsafe,
                          Eigen::Index stage) {
  return std::max(0.0, clearance(point, unsafe, stage));
}

Eigen::VectorXd clearances(const Points& points, const UnsafeSet& unsafe, Eigen::Index stage) {
  Eigen::ArrayXd least = Eigen::ArrayXd::Constant(points.cols(), kInfinity);
  for (const RegionPointer& region : unsafe.regions()) {
    region->lower_to_distances(stage, points, least);
  }
  // What is not a number is not safe; minima may have lost it.
  for (const auto& x : points.rowwise()) {
    least = (x.transpose().array().isFinite()).select(least, -kInfinity);
  }
  return least.matrix();
}

}  // namespace qsmpc::controller
