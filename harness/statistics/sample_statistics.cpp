#include "harness/statistics/sample_statistics.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "models/constants.hpp"

namespace qsmpc::harness {

double mean_of(const std::vector<double>& sample) {
  if (sample.empty()) return kNotANumber;
  return std::accumulate(sample.begin(), sample.end(), 0.0) / static_cast<double>(sample.size());
}

double mean_of_shares(const std::vector<double>& sample) {
  if (sample.empty()) return kNotANumber;
  const auto count = static_cast<double>(sample.size());
  double mean = 0.0;
  for (const double value : sample) mean += value / count;
  return mean;
}

double median_of(std::vector<double> sample) {
  if (sample.empty()) return kNotANumber;
  std::ranges::sort(sample);
  const std::size_t middle = sample.size() / 2;
  return sample.size() % 2 == 1 ? sample[middle] : 0.5 * (sample[middle - 1] + sample[middle]);
}

double largest_of(const std::vector<double>& sample) {
  return sample.empty() ? kNotANumber : *std::ranges::max_element(sample);
}

double standard_error_of(const std::vector<double>& sample) {
  return standard_error_about(sample, mean_of(sample));
}

double standard_error_about(const std::vector<double>& sample, double mean) {
  if (sample.size() < 2) return kNotANumber;
  double squares = 0.0;
  for (const double value : sample) squares += (value - mean) * (value - mean);
  const auto count = static_cast<double>(sample.size());
  return std::sqrt(squares / (count - 1.0) / count);
}

double standard_deviation_about(const std::vector<double>& sample, double mean) {
  if (sample.size() < 2) return kNotANumber;
  const auto count = static_cast<double>(sample.size());
  double variance = 0.0;
  for (const double value : sample) variance += (value - mean) * (value - mean) / (count - 1.0);
  return std::sqrt(variance);
}

}  // namespace qsmpc::harness
