#include "controller/control/mppi/sample_weights.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>

namespace qsmpc::controller {
namespace {

// Factor of the temperature steps until a bracket is found, …
constexpr double kBracketStep = 4.0;
// … the most steps of this search, and how often the bracket is then bisected (geometrically).
constexpr int kBracketSteps = 60;
constexpr int kTemperatureHalvings = 8;
// Unless all samples cost the same, no finite temperature makes all of them effective.
constexpr double kLargestShare = 0.99;

}  // namespace

double softmin_weights(const SampleCosts& samples, double temperature, Eigen::ArrayXd& weights) {
  const Eigen::Index count = samples.cost.size();
  const double inverse = 1.0 / temperature;
  double largest = -std::numeric_limits<double>::infinity();
  for (Eigen::Index i = 0; i < count; ++i) {
    weights[i] = -samples.cost[i] * inverse - samples.tilt[i];
    largest = std::max(largest, weights[i]);
  }
  if (std::isinf(largest)) {
    weights.setZero();
    return 0.0;
  }
  double sum = 0.0;
  double squares = 0.0;
  for (Eigen::Index i = 0; i < count; ++i) {
    weights[i] = std::exp(weights[i] - largest);
    sum += weights[i];
    squares += weights[i] * weights[i];
  }
  weights /= sum;
  return sum * sum / squares;
}

double effective_temperature(const SampleCosts& samples, double effective,
                             Eigen::ArrayXd& weights) {
  double least = std::numeric_limits<double>::infinity();
  double sum = 0.0;
  double finite = 0.0;
  for (const double cost : samples.cost) {
    if (!std::isfinite(cost)) continue;
    least = std::min(least, cost);
    sum += cost;
    finite += 1.0;
  }
  double temperature = sum / finite - least;
  if (!(temperature > 0.0) || !std::isfinite(temperature)) return 1.0;  // all cost the same
  const double wanted = std::min(effective, kLargestShare * finite);
  const auto is_hot = [&](double value) {
    return softmin_weights(samples, value, weights) >= wanted;
  };
  const bool begins_hot = is_hot(temperature);
  const double step = begins_hot ? 1.0 / kBracketStep : kBracketStep;
  double other = temperature * step;
  for (int n = 0; n < kBracketSteps && is_hot(other) == begins_hot; ++n) {
    temperature = other;
    other *= step;
  }
  double cold = begins_hot ? other : temperature;
  double hot = begins_hot ? temperature : other;
  for (int n = 0; n < kTemperatureHalvings; ++n) {
    const double middle = std::sqrt(cold * hot);
    (is_hot(middle) ? hot : cold) = middle;
  }
  return hot;
}

double conditional_value_at_risk(std::span<double> values, double level) {
  const double tail = (1.0 - level) * static_cast<double>(values.size());
  const std::size_t whole = std::min(values.size() - 1, static_cast<std::size_t>(std::floor(tail)));
  const auto last = values.begin() + static_cast<std::ptrdiff_t>(whole);
  std::nth_element(values.begin(), last, values.end(), std::greater<>());
  // Sorted, so that the sum does not depend on the order that the selection leaves.
  std::sort(values.begin(), last, std::greater<>());
  const double sum = std::accumulate(values.begin(), last, 0.0);
  return (sum + (tail - static_cast<double>(whole)) * *last) / tail;
}

}  // namespace qsmpc::controller
