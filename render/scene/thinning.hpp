// Fewer points where a picture would have too many.
#pragma once

#include <cstddef>

#include "render/frame.hpp"

namespace qsmpc::render {

/// Points of all overlays together that a frame should have at most: they cost about 10 ms.
inline constexpr std::size_t kMostOverlayPoints = 18'000;

/// The least n >= 1 for which every n-th of `points` are at most `limit` (at least 1).
[[nodiscard]] std::size_t thinning(std::size_t points, std::size_t limit);

/// Every `every`-th point (at least 1) in the order of their weights, the heaviest first and equal
/// ones as given, so that heavy and light points are thinned alike; their weights are scaled to the
/// sum they had. The same points every time.
[[nodiscard]] ParticleStage thinned(const ParticleStage& stage, std::size_t every);

}  // namespace qsmpc::render
