// Colours shared by the scene and its legend.
#pragma once

#include "render/colour.hpp"

namespace qsmpc::render::palette {

inline constexpr Colour kSky{0.60F, 0.73F, 0.86F};
inline constexpr Colour kHorizon{0.90F, 0.93F, 0.95F};
inline constexpr Colour kSafeGround{0.885F, 0.895F, 0.90F};
inline constexpr Colour kOuterGround{0.775F, 0.785F, 0.80F};
inline constexpr Colour kGridLine{0.58F, 0.61F, 0.65F, 0.42F};
inline constexpr Colour kShadow{0.10F, 0.12F, 0.18F, 0.26F};
inline constexpr Colour kObstacle{0.46F, 0.53F, 0.62F};
inline constexpr Colour kMovingObstacle{0.20F, 0.46F, 0.78F};
inline constexpr Colour kForecast{0.03F, 0.33F, 0.72F};
inline constexpr Colour kUnsafeEdge{0.80F, 0.22F, 0.10F};
inline constexpr Colour kUnsafeStripe{0.80F, 0.22F, 0.10F, 0.55F};
inline constexpr Colour kOuterStripe{0.80F, 0.22F, 0.10F, 0.22F};
inline constexpr Colour kWall{0.36F, 0.41F, 0.49F};
inline constexpr Colour kTarget{0.02F, 0.56F, 0.42F};
inline constexpr Colour kDrivenPath{0.13F, 0.24F, 0.42F};
inline constexpr Colour kPlannedPath{0.08F, 0.08F, 0.10F};
inline constexpr Colour kPlannedCasing{1.0F, 1.0F, 1.0F, 0.85F};
inline constexpr Colour kBody{1.0F, 0.88F, 0.15F};
inline constexpr Colour kBodyCasing{0.08F, 0.08F, 0.10F, 0.75F};
inline constexpr Colour kRawPoint{0.36F, 0.45F, 0.58F};
inline constexpr Colour kGhost{0.05F, 0.78F, 0.88F, 0.55F};
inline constexpr float kTubeOpacity = 0.55F;

}  // namespace qsmpc::render::palette
