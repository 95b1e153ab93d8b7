#include "controller/certification/error_truncation.hpp"

#include <array>
#include <cmath>

#include "controller/certification/statistical_linearisation.hpp"

namespace qsmpc::controller {
namespace {

/// A norm of one coordinate.
struct KnownNorm {
  int order;
  double value;
  double cost;  ///< probability allotted to truncation by it along the whole horizon
};

// By order 8, the truncation is at 8 times the norm for 24 coordinates and stages; by order 2, the
// same probability would put it at 5000 times.
constexpr double kMeanSquareCost = 1e-4;
constexpr std::array<double, kHigherOrders.size()> kHigherCosts = {1e-5, 1e-6};
constexpr double kNarrowCost = 1e-3;

/// The highest-order known norm of coordinate i.
KnownNorm highest_norm(const ModelError& error, Eigen::Index i) {
  KnownNorm highest{.order = 2, .value = error.root_mean_square[i], .cost = kMeanSquareCost};
  for (std::size_t k = 0; k < kHigherOrders.size(); ++k) {
    if (!std::isfinite(error.higher[k][i])) continue;
    highest = {.order = kHigherOrders[k], .value = error.higher[k][i], .cost = kHigherCosts[k]};
  }
  return highest;
}

}  // namespace

TruncatedError truncate_error(const ModelError& error, Eigen::Index count, double reach) {
  const Eigen::Index dim = error.root_mean_square.size();
  TruncatedError cut{.bound = StageError::none(dim)};
  cut.bound.mean_square() = error.root_mean_square;
  for (Eigen::Index i = 0; i < dim; ++i) {
    // A zero error is zero in every norm.
    if (error.root_mean_square[i] == 0.0) continue;
    for (std::size_t k = 0; k < kHigherOrders.size(); ++k) {
      cut.bound.higher(k)[i] = error.higher[k][i];
    }
    const KnownNorm norm = highest_norm(error, i);
    const double cost = reach < kWideCore ? kNarrowCost : norm.cost;
    const double share = cost / static_cast<double>(count * dim);
    // Markov: P(|e_i| > share^{−1/p} ‖e_i‖_p) ≤ share.
    cut.bound.largest()[i] = norm.value * std::pow(share, -1.0 / norm.order);
    cut.outside += share;
  }
  return cut;
}

}  // namespace qsmpc::controller
