// Draws from which those of any law are made: random ones, and quasi-random ones, whose averages
// are closer to expectations than those of as many random ones.
#pragma once

#include <cstdint>

#include <Eigen/Core>

#include "controller/measure/measures.hpp"

#pragma GCC visibility push(default)

namespace qsmpc::controller {

/// `count` independent pairs of a uniform number, which chooses a component of a mixture, and a
/// standard normal vector.
struct StandardDraws {
  Eigen::VectorXd choices;  ///< count, uniform in (0, 1]
  Points normals;           ///< dim x count

  [[nodiscard]] Eigen::Index count() const { return choices.size(); }
};

/// Draws that depend only on `seed`, independent of the draws behind simulated paths of the model.
/// dim, count ≥ 1.
[[nodiscard]] StandardDraws random_draws(Eigen::Index dim, Eigen::Index count, std::uint64_t seed);

/// The points of Richtmyer's sequence, multiples of the roots of primes modulo 1, beside
/// equidistant choices, by the inverse of Φ. dim, count ≥ 1.
[[nodiscard]] StandardDraws quasi_random_draws(Eigen::Index dim, Eigen::Index count);

/// First path numbers (models::RandomStream::kPrediction) of the method "monte_carlo" and of
/// `random_draws`. No simulation uses path numbers in these ranges, so that a law and the paths it
/// is compared with are independent, whatever their seeds.
inline constexpr std::uint64_t kFirstMethodPath = std::uint64_t{1} << 63;
inline constexpr std::uint64_t kFirstLawDraw = std::uint64_t{3} << 62;

/// x with Φ(x) = probability, 0 < probability < 1.
[[nodiscard]] double normal_quantile(double probability);

}  // namespace qsmpc::controller

#pragma GCC visibility pop
