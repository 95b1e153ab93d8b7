// Confidence limits of a probability from a count of events.
#pragma once

#include <cstdint>

namespace qsmpc::harness {

struct RateInterval {
  double lower = 0.0;
  double upper = 1.0;
};

/// Clopper–Pearson limits of the probability of an event that occurred in `events` of `trials`
/// independent trials: each limit on its own is wrong with probability at most `tail`, whatever the
/// true probability is. Throws std::invalid_argument unless 0 ≤ events ≤ trials, trials ≥ 1 and
/// 0 < tail < 1. (Clopper and Pearson: "The use of confidence or fiducial limits", Biometrika 26,
/// 1934.)
[[nodiscard]] RateInterval clopper_pearson(std::int64_t events, std::int64_t trials, double tail);

}  // namespace qsmpc::harness
