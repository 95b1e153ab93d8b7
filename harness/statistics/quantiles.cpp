#include "harness/statistics/quantiles.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <stdexcept>

#include "models/constants.hpp"

namespace qsmpc::harness {

std::int64_t nearest_rank(double share, std::int64_t count) {
  const auto rank = static_cast<std::int64_t>(std::ceil(share * static_cast<double>(count)));
  return std::max<std::int64_t>(rank, 1);
}

const std::vector<double>& distribution_shares() {
  static const std::vector<double> shares{0.5, 0.95, 0.99, 1.0};
  return shares;
}

SortedQuantiles::SortedQuantiles(std::int64_t count, const std::vector<double>& shares)
    : values_(shares.size(), kNotANumber) {
  const bool in_range = std::ranges::all_of(shares, [](double q) { return q >= 0.0 && q <= 1.0; });
  if (count < 0 || !in_range || !std::ranges::is_sorted(shares)) {
    throw std::invalid_argument("quantiles: an invalid count or invalid shares");
  }
  for (const double share : shares) ranks_.push_back(nearest_rank(share, count));
}

void SortedQuantiles::add(double value, std::int64_t times) {
  added_ += times;
  for (; next_ < ranks_.size() && ranks_[next_] <= added_; ++next_) values_[next_] = value;
}

SortedDistribution::SortedDistribution(std::int64_t count)
    : quantiles_(count, distribution_shares()) {}

void SortedDistribution::add(double value) {
  quantiles_.add(value);
  ++added_;
  sum_ += value;
}

Distribution SortedDistribution::result() const {
  const std::vector<double>& values = quantiles_.values();
  return {.median = values[0],
          .p95 = values[1],
          .p99 = values[2],
          .max = values[3],
          .mean = added_ == 0 ? kNotANumber : sum_ / static_cast<double>(added_)};
}

Distribution distribution_or_zeros(std::vector<double> sample) {
  if (sample.empty()) return {};
  std::ranges::sort(sample);
  SortedDistribution distribution(std::ssize(sample));
  for (const double value : sample) distribution.add(value);
  return distribution.result();
}

void RunningMean::add(double value) {
  ++count_;
  const double before = value - mean_;
  mean_ += before / static_cast<double>(count_);
  squares_ += before * (value - mean_);
}

double RunningMean::mean() const { return count_ == 0 ? kNotANumber : mean_; }

double RunningMean::standard_error() const {
  if (count_ < 2) return kNotANumber;
  const auto count = static_cast<double>(count_);
  return std::sqrt(squares_ / (count - 1.0) / count);
}

}  // namespace qsmpc::harness
