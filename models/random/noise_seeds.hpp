// A drive whose noise is drawn by one seed up to a period, and by others from there on: two drives
// with the same seeds below a period are the same up to it, and independent after it.
#pragma once

#include <cstdint>
#include <vector>

namespace qsmpc::models {

/// From a period on, noise is drawn by this seed.
struct NoiseSeed {
  std::uint64_t from = 0;  ///< period
  std::uint64_t seed = 0;

  friend bool operator==(const NoiseSeed&, const NoiseSeed&) = default;
};

/// The seed of the noise of period `period`: that of the last entry of `seeds` (ascending by
/// `from`) which begins by then, or `first` where there is none.
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
