// What a sample of numbers is summed up by.
#pragma once

#include <vector>

namespace qsmpc {

/// The mean; not a number for an empty sample.
[[nodiscard]] double mean_of(const std::vector<double>& sample);

/// The middle one of the sorted sample, or the mean of the two in the middle; not a number for an
/// empty sample.
[[nodiscard]] double median_of(std::vector<double> sample);

/// The greatest; not a number for an empty sample.
[[nodiscard]] double largest_of(const std::vector<double>& sample);

/// The standard error of the mean; not a number for fewer than two numbers.
[[nodiscard]] double standard_error_of(const std::vector<double>& sample);

}  // namespace qsmpc
