// Colours of pictures: named ones in palette.hpp, and the ramp of the horizon's stages.
#pragma once

#pragma GCC visibility push(default)

namespace qsmpc::render {

/// sRGB and opacity, each in [0, 1].
struct Colour {
  float red = 0.0F;
  float green = 0.0F;
  float blue = 0.0F;
  float alpha = 1.0F;

  [[nodiscard]] constexpr Colour with_alpha(float value) const { return {red, green, blue, value}; }
};

/// `first` at share 0, `second` at share 1, linear between, including the opacity.
[[nodiscard]] constexpr Colour mix(const Colour& first, const Colour& second, float share) {
  return {first.red + share * (second.red - first.red),
          first.green + share * (second.green - first.green),
          first.blue + share * (second.blue - first.blue),
          first.alpha + share * (second.alpha - first.alpha)};
}

/// Matplotlib's "plasma" (perceptually uniform, readable with any colour vision) from 0 to 1.
/// A share outside [0, 1] is clamped.
[[nodiscard]] Colour plasma(double share);

/// The colour of `stage` among `stages`: plasma without its palest end, which is hard to see on
/// light ground.
[[nodiscard]] Colour stage_colour(int stage, int stages);

/// Probabilities up to this value have the calmest colour.
inline constexpr double kLeastRisk = 1e-6;

/// The colour of a probability (bound) of being unsafe, on a logarithmic scale from kLeastRisk to
/// 1. NaN counts as 1.
[[nodiscard]] Colour risk_colour(double probability);

/// m; clearances from this value on have the calmest colour.
inline constexpr double kCalmClearance = 1.0;

/// The colour of a distance (m) to the unsafe set: warning up to 0, calm from kCalmClearance on.
[[nodiscard]] Colour clearance_colour(double clearance);

}  // namespace qsmpc::render

#pragma GCC visibility pop
