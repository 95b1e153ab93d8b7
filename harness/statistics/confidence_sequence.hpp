// Confidence limits of a probability that hold at all numbers of trials simultaneously.
#pragma once

#include <cstdint>

#include "harness/statistics/binomial_interval.hpp"

namespace qsmpc::harness {

/// The interval of a confidence sequence for the probability of an event that occurred in `events`
/// of `trials` independent trials. With probability at least `confidence` the true value is inside
/// the intervals of all numbers of trials simultaneously. The interval therefore also holds at a
/// number of trials that depends on the observations, where an interval for a fixed number, such as
/// clopper_pearson, does not.
///
/// The set of p with M(p) < 1/(1 − confidence), where M(p) = ∫ qˢ (1 − q)ⁿ⁻ˢ π(dq) / pˢ (1 − p)ⁿ⁻ˢ
/// is a martingale under p, with s events of n trials and π = Beta(½, ½): Ville's inequality.
/// (Robbins: "Statistical methods related to the law of the iterated logarithm", Annals of
/// Mathematical Statistics 41, 1970; Howard, Ramdas, McAuliffe, Sekhon: "Time-uniform,
/// nonparametric, nonasymptotic confidence sequences", Annals of Statistics 49, 2021.)
///
/// Without trials it is [0, 1]. Throws std::invalid_argument unless 0 ≤ events ≤ trials and
/// 0 < confidence < 1.
[[nodiscard]] RateInterval confidence_sequence(std::int64_t events, std::int64_t trials,
                                               double confidence);

}  // namespace qsmpc::harness
