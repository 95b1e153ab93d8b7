// What a count of events says about their probability.
#pragma once

#include <cstdint>

namespace qsmpc::harness {

struct RateInterval {
  double lower = 0.0;
  double upper = 1.0;
};

/// Clopper–Pearson limits of the probability of an event that was seen in `events` of `trials`
/// independent trials: each limit alone is wrong with a probability of at most `tail`, whatever the
/// true one is. Throws std::invalid_argument unless 0 ≤ events ≤ trials, trials ≥ 1 and
/// 0 < tail < 1. (Clopper and Pearson: "The use of confidence or fiducial limits", Biometrika 26,
/// 1934.)
[[nodiscard]] RateInterval clopper_pearson(std::int64_t events, std::int64_t trials, double tail);

}  // namespace qsmpc::harness
