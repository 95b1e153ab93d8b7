// What a sample of numbers is summed up by.
#pragma once

#include <vector>

namespace qsmpc::harness {

/// The mean; not a number for an empty sample.
[[nodiscard]] double mean_of(const std::vector<double>& sample);

/// The mean as the sum of each number's share, value / count. It differs from `mean_of` in the last
/// digits; results that were published with it keep them. Not a number for an empty sample.
[[nodiscard]] double mean_of_shares(const std::vector<double>& sample);

/// The middle one of the sorted sample, or the mean of the two in the middle; not a number for an
/// empty sample.
[[nodiscard]] double median_of(std::vector<double> sample);

/// The greatest; not a number for an empty sample.
[[nodiscard]] double largest_of(const std::vector<double>& sample);

/// The standard error of the mean; not a number for fewer than two numbers.
[[nodiscard]] double standard_error_of(const std::vector<double>& sample);

/// The same about `mean`, the mean of the sample as the caller computed it.
[[nodiscard]] double standard_error_about(const std::vector<double>& sample, double mean);

/// The standard deviation about `mean`, the mean of the sample, with the divisor count − 1; not a
/// number for fewer than two numbers.
[[nodiscard]] double standard_deviation_about(const std::vector<double>& sample, double mean);

}  // namespace qsmpc::harness
