// The nearest of many points, by a tree of halved boxes. For tests only: plain sampling with it
// checks what the library reports about its quantisers.
#pragma once

#include <algorithm>
#include <limits>
#include <numeric>
#include <vector>

#include "controller/measure/measures.hpp"

namespace qsmpc::testing {

class NearestPoint {
 public:
  explicit NearestPoint(const controller::Points& points)
      : dim_(static_cast<int>(points.rows())), order_(points.cols()) {
    std::iota(order_.begin(), order_.end(), 0);
    split(points, 0, static_cast<int>(order_.size()));
    for (const int i : order_) {
      for (int axis = 0; axis < dim_; ++axis) sorted_.push_back(points(axis, i));
    }
  }

  /// min |x − c_n|².
  [[nodiscard]] double squared_distance(const double* x) const {
    double nearest = std::numeric_limits<double>::infinity();
    visit(x, 0, 0, static_cast<int>(order_.size()), nearest);
    return nearest;
  }

 private:
  static constexpr int kLeaf = 8;  // a box with fewer points is not halved
  struct Cut {
    int axis = 0;
    double at = 0.0;
  };

  // Cuts are stored in depth-first order; the cuts of the left half follow their parent.
  static int cuts_of(int count) {
    return count <= kLeaf ? 0 : 1 + cuts_of(count / 2) + cuts_of(count - count / 2);
  }

  void split(const controller::Points& points, int begin, int end) {
    if (end - begin <= kLeaf) return;
    const std::vector<int> inside(order_.begin() + begin, order_.begin() + end);
    const controller::Points box = points(Eigen::all, inside);
    int axis = 0;
    (box.rowwise().maxCoeff() - box.rowwise().minCoeff()).maxCoeff(&axis);
    const int middle = begin + (end - begin) / 2;
    std::nth_element(order_.begin() + begin, order_.begin() + middle, order_.begin() + end,
                     [&](int a, int b) { return points(axis, a) < points(axis, b); });
    cuts_.push_back({.axis = axis, .at = points(axis, order_[middle])});
    right_.push_back(static_cast<int>(cuts_.size()) + cuts_of(middle - begin));
    split(points, begin, middle);
    split(points, middle, end);
  }

  void visit(const double* x, int cut, int begin, int end, double& nearest) const {
    if (end - begin <= kLeaf) {
      for (int i = begin; i < end; ++i) {
        double square = 0.0;
        for (int axis = 0; axis < dim_; ++axis) {
          const double offset = x[axis] - sorted_[i * dim_ + axis];
          square += offset * offset;
        }
        nearest = std::min(nearest, square);
      }
      return;
    }
    const int middle = begin + (end - begin) / 2;
    const double beyond = x[cuts_[cut].axis] - cuts_[cut].at;
    if (beyond < 0.0) {
      visit(x, cut + 1, begin, middle, nearest);
      if (beyond * beyond < nearest) visit(x, right_[cut], middle, end, nearest);
    } else {
      visit(x, right_[cut], middle, end, nearest);
      if (beyond * beyond < nearest) visit(x, cut + 1, begin, middle, nearest);
    }
  }

  int dim_;
  std::vector<int> order_;
  std::vector<Cut> cuts_;
  std::vector<int> right_;      // the first cut of the right half
  std::vector<double> sorted_;  // coordinates, point by point
};

}  // namespace qsmpc::testing
