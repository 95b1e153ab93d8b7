// Thinning of points where a picture would have too many.
#pragma once

#include <cstddef>

#include "render/frame.hpp"

namespace qsmpc::render {

/// Most points that all overlays of a frame should have together; they cost about 10 ms.
inline constexpr std::size_t kMostOverlayPoints = 18'000;

/// The least n >= 1 such that every n-th of `points` points gives at most `limit` (at least 1).
[[nodiscard]] std::size_t thinning(std::size_t points, std::size_t limit);

/// Every `every`-th point (at least 1) in order of weight, the heaviest first and equal ones as
/// given, so that heavy and light points are thinned alike; the weights are rescaled to the
/// original sum. The choice is deterministic.
[[nodiscard]] ParticleStage thinned(const ParticleStage& stage, std::size_t every);

}  // namespace qsmpc::render
