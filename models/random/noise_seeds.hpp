// A drive whose noise is drawn with one seed up to a period and with others afterwards: two drives
// with the same seeds before a period are identical up to it, and independent after it.
#pragma once

#include <cstdint>
#include <vector>

namespace qsmpc::models {

/// From a period on, noise is drawn with this seed.
struct NoiseSeed {
  std::uint64_t from = 0;  ///< period
  std::uint64_t seed = 0;

  friend bool operator==(const NoiseSeed&, const NoiseSeed&) = default;
};

/// The seed of the noise of period `period`: that of the last entry of `seeds` (ascending by
/// `from`) with from ≤ period, or `first` if there is none.
[[nodiscard]] inline std::uint64_t noise_seed_at(const std::vector<NoiseSeed>& seeds,
                                                 std::uint64_t first, std::uint64_t period) {
  std::uint64_t seed = first;
  for (const NoiseSeed& entry : seeds) {
    if (entry.from > period) break;
    seed = entry.seed;
  }
  return seed;
}

}  // namespace qsmpc::models
