#include "controller/measure/gaussian_quantiser.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>

#include <Eigen/Eigenvalues>

#include "controller/measure/normal_quantiser.hpp"

namespace qsmpc {
namespace {

/// Depth-first search over the levels of axes sorted by falling variance.
class LevelSearch {
 public:
  LevelSearch(Eigen::VectorXd variances, int budget)
      : variances_(std::move(variances)), current_(variances_.size(), 1), best_(current_) {
    visit(0, budget, budget, 0.0);
  }
  [[nodiscard]] const std::vector<int>& best() const { return best_; }

 private:
  // `left`: what remains of the budget; `ceiling`: the level of the axis before.
  void visit(Eigen::Index axis, int left, int ceiling, double error) {
    if (error >= best_error_) return;
    if (axis == variances_.size()) {
      best_error_ = error;
      best_ = current_;
      return;
    }
    if (variances_[axis] <= 0.0) {
      visit(axis + 1, left, 1, error);  // sorted: all further axes are degenerate, too
      return;
    }
    const int most = std::min(left, ceiling);
    const int least = axis + 1 == variances_.size() ? most : 1;
    for (int level = most; level >= least; --level) {
      current_[axis] = level;
      visit(axis + 1, left / level, level,
            error + variances_[axis] * approximate_distortion(level));
    }
    current_[axis] = 1;
  }

  Eigen::VectorXd variances_;
  std::vector<int> current_;
  std::vector<int> best_;
  double best_error_ = std::numeric_limits<double>::infinity();
};

}  // namespace

std::vector<int> allot_levels(const Eigen::Ref<const Eigen::VectorXd>& variances, int budget) {
  if (budget < 1) throw std::invalid_argument("quantiser: the budget must be at least one point");
  if (!variances.allFinite() || (variances.array() < 0.0).any()) {
    throw std::invalid_argument("quantiser: variances must be finite and not negative");
  }
  std::vector<Eigen::Index> order(variances.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](auto a, auto b) { return variances[a] > variances[b]; });
  Eigen::VectorXd sorted(variances.size());
  for (std::size_t i = 0; i < order.size(); ++i) sorted[i] = variances[order[i]];
  const LevelSearch search(sorted, budget);
  std::vector<int> levels(order.size());
  for (std::size_t i = 0; i < order.size(); ++i) levels[order[i]] = search.best()[i];
  return levels;
}

GaussianQuantisation quantise(const Gaussian& gaussian, int budget) {
  check_gaussian(gaussian);
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(gaussian.covariance);
  const Eigen::VectorXd variances = eigen.eigenvalues().cwiseMax(0.0);
  const Eigen::Index dim = variances.size();

  GaussianQuantisation result;
  result.levels = allot_levels(variances, budget);
  Eigen::Index count = 1;
  Eigen::VectorXd lost(dim);
  for (Eigen::Index axis = 0; axis < dim; ++axis) {
    count *= result.levels[axis];
    lost[axis] = variances[axis] * normal_quantiser(result.levels[axis]).distortion;
  }
  Points grid(dim, count);
  result.measure.weights = Eigen::VectorXd::Ones(count);
  Eigen::Index stride = 1;
  for (Eigen::Index axis = 0; axis < dim; ++axis) {
    const NormalQuantiser& quantiser = normal_quantiser(result.levels[axis]);
    const double deviation = std::sqrt(variances[axis]);
    for (Eigen::Index i = 0; i < count; ++i) {
      const Eigen::Index level = (i / stride) % result.levels[axis];
      grid(axis, i) = deviation * quantiser.points[level];
      result.measure.weights[i] *= quantiser.weights[level];
    }
    stride *= result.levels[axis];
  }
  const auto& basis = eigen.eigenvectors();
  result.measure.locations = (basis * grid).colwise() + gaussian.mean;
  result.within_covariance = basis * lost.asDiagonal() * basis.transpose();
  result.w2 = std::sqrt(lost.sum());
  return result;
}

}  // namespace qsmpc
