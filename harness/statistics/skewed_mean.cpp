#include "harness/statistics/skewed_mean.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/students_t.hpp>

#include "harness/statistics/sample_statistics.hpp"

namespace qsmpc::harness {
namespace {

/// Limits of the mean of a lognormal distribution, from the logarithms of at least two samples.
RateInterval lognormal_mean(const std::vector<double>& logarithms, double tail) {
  const auto count = static_cast<double>(logarithms.size());
  const double mean = mean_of(logarithms);
  const double deviation = standard_deviation_about(logarithms, mean);
  const double variance = deviation * deviation;
  const double freedom = count - 1.0;
  const double t = quantile(boost::math::students_t(freedom), 1.0 - tail);
  const boost::math::chi_squared chi_squared(freedom);
  const double of_mean = t * t * variance / count;
  const auto half_length = [&](double of_variance) { return std::sqrt(of_mean + of_variance); };
  const double cox = half_length(t * t * variance * variance / (2.0 * freedom));
  const auto of_limit = [&](double probability) {
    const double limit = freedom * variance / quantile(chi_squared, probability);
    return std::pow(0.5 * (limit - variance), 2.0);
  };
  const double centre = mean + 0.5 * variance;
  return {.lower = std::exp(centre - std::max(cox, half_length(of_limit(1.0 - tail)))),
          .upper = std::exp(centre + std::max(cox, half_length(of_limit(tail))))};
}

}  // namespace

RateInterval skewed_mean_interval(const std::vector<double>& sample, double tail) {
  if (!(tail > 0.0 && tail < 0.5))
    throw std::invalid_argument("skewed mean: tail outside of (0, 0.5)");
  std::vector<double> logarithms;
  for (const double value : sample) {
    if (!(value >= 0.0) || !std::isfinite(value)) {
      throw std::invalid_argument("skewed mean: a number that is negative or not finite");
    }
    if (value > 0.0) logarithms.push_back(std::log(value));
  }
  if (logarithms.size() < 2) {
    return {.lower = 0.0, .upper = std::numeric_limits<double>::infinity()};
  }
  if (logarithms.size() == sample.size()) return lognormal_mean(logarithms, tail);
  const RateInterval share =
      clopper_pearson(std::ssize(logarithms), std::ssize(sample), 0.5 * tail);
  const RateInterval mean = lognormal_mean(logarithms, 0.5 * tail);
  return {.lower = share.lower * mean.lower, .upper = share.upper * mean.upper};
}

}  // namespace qsmpc::harness
