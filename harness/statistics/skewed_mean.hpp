// Confidence limits of the mean of a right-skewed distribution from a few independent, non-negative
// samples, such as estimates of a small probability.
#pragma once

#include <vector>

#include "harness/statistics/binomial_interval.hpp"

namespace qsmpc::harness {

/// Limits of the mean of the distribution that `sample` (non-negative) is drawn from. Each is wrong
/// with probability at most about `tail` where the logarithms of the positive values are normal.
/// The lower limit is at least 0, the upper one may be infinite; with fewer than two positive
/// values they are 0 and infinity.
///
/// The interval is the hull of two intervals of the mean of a lognormal distribution, with Student
/// quantiles in place of normal ones, since each is too short on one side for small samples: Cox's
/// (Olsson: "Confidence intervals for the mean of a log-normal distribution", Journal of Statistics
/// Education 13, 2005) and the one that combines the limits of mean and variance as a sum of
/// squares (Zou, Huo, Taleban: "Simple confidence intervals for lognormal means and their
/// differences", Environmetrics 20, 2009). Where some values are 0, the share of positive values
/// gets Clopper–Pearson limits, and each of the two intervals gets half of the error probability.
///
/// Throws std::invalid_argument on a value that is negative or not finite, and on a tail outside
/// (0, 1/2).
[[nodiscard]] RateInterval skewed_mean_interval(const std::vector<double>& sample, double tail);

}  // namespace qsmpc::harness
