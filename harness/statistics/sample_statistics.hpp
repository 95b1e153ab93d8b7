// Summary statistics of a sample.
#pragma once

#include <vector>

namespace qsmpc::harness {

/// The mean; NaN for an empty sample.
[[nodiscard]] double mean_of(const std::vector<double>& sample);

/// The mean, computed as Σ (value / count). It differs from `mean_of` in the last digits and
/// reproduces results that were published with it. NaN for an empty sample.
[[nodiscard]] double mean_of_shares(const std::vector<double>& sample);

/// The median: the middle value, or the mean of the two middle values; NaN for an empty sample.
[[nodiscard]] double median_of(std::vector<double> sample);

/// The maximum; NaN for an empty sample.
[[nodiscard]] double largest_of(const std::vector<double>& sample);

/// The standard error of the mean; NaN for fewer than two values.
[[nodiscard]] double standard_error_of(const std::vector<double>& sample);

/// The same about `mean`, the mean of the sample as the caller computed it.
[[nodiscard]] double standard_error_about(const std::vector<double>& sample, double mean);

/// The standard deviation about `mean`, the mean of the sample, with the divisor count − 1; NaN for
/// fewer than two values.
[[nodiscard]] double standard_deviation_about(const std::vector<double>& sample, double mean);

}  // namespace qsmpc::harness
