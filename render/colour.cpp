#include "render/colour.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace qsmpc::render {
namespace {

// Matplotlib's table at every tenth of its range (released into the public domain, CC0).
constexpr std::array<Colour, 11> kPlasma{{{0.050F, 0.030F, 0.528F},
                                          {0.254F, 0.014F, 0.615F},
                                          {0.418F, 0.001F, 0.658F},
                                          {0.563F, 0.052F, 0.642F},
                                          {0.692F, 0.165F, 0.564F},
                                          {0.798F, 0.280F, 0.470F},
                                          {0.881F, 0.393F, 0.383F},
                                          {0.949F, 0.518F, 0.296F},
                                          {0.988F, 0.652F, 0.211F},
                                          {0.988F, 0.809F, 0.145F},
                                          {0.940F, 0.975F, 0.131F}}};
constexpr double kPalestShare = 0.86;

// Lightness falls evenly (CIE L* about 90, 75, 60, 46, 31), so that the order is visible with any
// colour vision; pale blue is calm, dark red alarming.
constexpr std::array<Colour, 5> kRisk{{{0.70F, 0.93F, 0.87F},
                                       {0.42F, 0.75F, 0.86F},
                                       {0.45F, 0.53F, 0.83F},
                                       {0.60F, 0.27F, 0.60F},
                                       {0.56F, 0.02F, 0.13F}}};
// From crimson through sand to teal: distinct from the colours of the stages, with a lightness that
// rises and falls, so that the ends differ from the middle with any colour vision.
constexpr std::array<Colour, 3> kClearance{
    {{0.76F, 0.08F, 0.16F}, {0.78F, 0.68F, 0.46F}, {0.02F, 0.50F, 0.47F}}};

template <std::size_t count>
Colour on_ramp(const std::array<Colour, count>& ramp, double share) {
  const double position = std::clamp(share, 0.0, 1.0) * (count - 1);
  const auto index = std::min(static_cast<std::size_t>(position), count - 2);
  return mix(ramp[index], ramp[index + 1],
             static_cast<float>(position - static_cast<double>(index)));
}

}  // namespace

Colour plasma(double share) { return on_ramp(kPlasma, share); }

Colour stage_colour(int stage, int stages) {
  const double share = stages > 1 ? static_cast<double>(stage) / (stages - 1) : 0.0;
  return plasma(kPalestShare * share);
}

Colour risk_colour(double probability) {
  if (!(probability > 0.0)) {
    return std::isnan(probability) ? kRisk.back() : kRisk.front();
  }
  const double least = std::log10(kLeastRisk);
  return on_ramp(kRisk, (std::log10(probability) - least) / -least);
}

Colour clearance_colour(double clearance) {
  return on_ramp(kClearance, clearance / kCalmClearance);
}

}  // namespace qsmpc::render
