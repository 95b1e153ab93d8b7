// The mean of a few independent numbers, none negative, whose law is skewed to the right: estimates
// of a small probability.
#pragma once

#include <vector>

#include "harness/statistics/binomial_interval.hpp"

namespace qsmpc::harness {

/// Limits of the mean of the law that `sample` (none negative) is drawn from, each wrong with a
/// probability of at most about `tail` where the logarithms of its positive numbers are normal; the
/// lower one is at least 0, the upper one may be infinite. With fewer than two positive numbers
/// nothing is known: 0 and infinity.
///
/// It is the hull of two intervals of the mean of a lognormal law, with Student's quantiles for
/// those of the normal law, since each is too short on one side for a handful of numbers: Cox's
/// (Olsson: "Confidence intervals for the mean of a log-normal distribution", Journal of Statistics
/// Education 13, 2005) and the one that adds the limits of mean and variance as squares (Zou, Huo,
/// Taleban: "Simple confidence intervals for lognormal means and their differences", Environmetrics
/// 20, 2009). Where some of the sample is 0, the share of the others has Clopper–Pearson limits,
/// and each of the two pairs gets half of the error.
///
/// Throws std::invalid_argument on a number that is negative or not finite, and on a tail that is
/// not between 0 and 1/2.
[[nodiscard]] RateInterval skewed_mean_interval(const std::vector<double>& sample, double tail);

}  // namespace qsmpc::harness
