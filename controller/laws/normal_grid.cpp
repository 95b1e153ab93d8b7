#include "controller/laws/normal_grid.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <utility>
#include <vector>

#include "models/linear_algebra.hpp"

namespace qsmpc::controller {
namespace {

/// A node's key on every axis: its rule and its index in the rule. The centre, which all rules of
/// odd size share, counts as that of the first.
using NodeKey = std::vector<std::pair<int, int>>;

std::vector<NormalGrid> rules_up_to(int count) {
  std::vector<NormalGrid> rules;
  for (int size = 1; size <= count; ++size) rules.push_back(gauss_hermite(size));
  return rules;
}

double binomial(Eigen::Index n, int k) {
  double value = 1.0;
  for (int i = 1; i <= k; ++i) value *= static_cast<double>(n - k + i) / i;
  return value;
}

/// Collects products of rules, adding up the weights of nodes that they share.
class GridSum {
 public:
  GridSum(const std::vector<NormalGrid>& rules, Eigen::Index dim)
      : rules_(rules), dim_(dim), key_(dim) {}

  /// Adds `factor` times the product of the rules of sizes[0], sizes[1], …
  void add(const std::vector<int>& sizes, double factor) { add_axis(sizes, 0, factor); }

  [[nodiscard]] NormalGrid grid() const {
    NormalGrid grid{.nodes = Points(dim_, static_cast<Eigen::Index>(weights_.size())),
                    .weights = Eigen::VectorXd(static_cast<Eigen::Index>(weights_.size()))};
    Eigen::Index node = 0;
    for (const auto& [key, weight] : weights_) {
      for (Eigen::Index axis = 0; axis < dim_; ++axis) {
        const auto& [size, index] = key[axis];
        grid.nodes(axis, node) = rules_[static_cast<std::size_t>(size) - 1].nodes(0, index);
      }
      grid.weights[node++] = weight;
    }
    return grid;
  }

 private:
  void add_axis(const std::vector<int>& sizes, Eigen::Index axis, double weight) {
    if (axis == dim_) {
      weights_[key_] += weight;
      return;
    }
    const int size = sizes[axis];
    const NormalGrid& rule = rules_[static_cast<std::size_t>(size) - 1];
    for (int index = 0; index < size; ++index) {
      const bool centre = 2 * index + 1 == size;
      key_[axis] = centre ? std::pair(1, 0) : std::pair(size, index);
      add_axis(sizes, axis + 1, weight * rule.weights[index]);
    }
  }

  const std::vector<NormalGrid>& rules_;
  Eigen::Index dim_;
  NodeKey key_;
  std::map<NodeKey, double> weights_;
};

/// Smolyak's sum: every choice of rule sizes 1 + level_j with Σ level_j = L − k, 0 ≤ k < dim, with
/// the factor (−1)^k binomial(dim − 1, k). From `axis` on, at most `left` levels remain to be
/// distributed.
void add_smolyak(Eigen::Index axis, int left, std::vector<int>& sizes, GridSum& sum) {
  const auto dim = static_cast<Eigen::Index>(sizes.size());
  if (axis == dim) {
    if (left < dim) sum.add(sizes, (left % 2 == 0 ? 1.0 : -1.0) * binomial(dim - 1, left));
    return;
  }
  for (int level = 0; level <= left; ++level) {
    sizes[axis] = 1 + level;
    add_smolyak(axis + 1, left - level, sizes, sum);
  }
}

}  // namespace

NormalGrid gauss_hermite(int count) {
  Eigen::MatrixXd jacobi = Eigen::MatrixXd::Zero(count, count);
  for (int k = 1; k < count; ++k) jacobi(k, k - 1) = jacobi(k - 1, k) = std::sqrt(k);
  const models::SymmetricEigen eigen = models::symmetric_eigen(jacobi);
  NormalGrid rule{.nodes = eigen.values.transpose(),
                  .weights = eigen.vectors.row(0).cwiseAbs2().transpose()};
  // Symmetric to the last bit, as the rule is.
  rule.nodes = Points(0.5 * (rule.nodes - rule.nodes.rowwise().reverse()));
  rule.weights = Eigen::VectorXd(0.5 * (rule.weights + rule.weights.reverse()));
  return rule;
}

NormalGrid normal_grid(Eigen::Index dim, int order, int most_nodes) {
  const std::vector<NormalGrid> rules = rules_up_to(order + 1);
  GridSum sum(rules, dim);
  const double full = std::pow(order + 1.0, static_cast<double>(dim));
  std::vector<int> sizes(dim, order + 1);
  if (full <= most_nodes) {
    sum.add(sizes, 1.0);
  } else {
    add_smolyak(0, order, sizes, sum);
  }
  return sum.grid();
}

}  // namespace qsmpc::controller
