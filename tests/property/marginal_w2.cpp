#include "tests/property/marginal_w2.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace qsmpc::testing {
namespace {

// Three times √2.5.
constexpr double kSamplingFactor = 3.0 * 1.6;

}  // namespace

double marginal_w2(const controller::DiscreteMeasure& particles, const controller::Points& draws,
                   Eigen::Index axis) {
  std::vector<double> sorted(draws.row(axis).begin(), draws.row(axis).end());
  std::sort(sorted.begin(), sorted.end());
  std::vector<Eigen::Index> order(particles.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = static_cast<Eigen::Index>(i);
  std::sort(order.begin(), order.end(), [&](Eigen::Index a, Eigen::Index b) {
    return particles.locations(axis, a) < particles.locations(axis, b);
  });
  // The monotone coupling: sorted particles take sorted draws according to their weights.
  const double each = 1.0 / static_cast<double>(sorted.size());
  double squares = 0.0;
  double left = each;
  std::size_t draw = 0;
  for (const Eigen::Index i : order) {
    double weight = particles.weights[i];
    while (weight > 0.0 && draw < sorted.size()) {
      const double moved = std::min(weight, left);
      const double distance = particles.locations(axis, i) - sorted[draw];
      squares += moved * distance * distance;
      weight -= moved;
      left -= moved;
      if (left <= 0.0) {
        ++draw;
        left = each;
      }
    }
  }
  return std::sqrt(squares);
}

double sampling_w2(const controller::Points& draws, Eigen::Index axis) {
  const double mean = draws.row(axis).mean();
  const double deviation = std::sqrt((draws.row(axis).array() - mean).square().mean());
  return kSamplingFactor * deviation / std::sqrt(static_cast<double>(draws.cols()));
}

}  // namespace qsmpc::testing
