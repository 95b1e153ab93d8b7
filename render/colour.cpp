#include "render/colour.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace qsmpc {
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

}  // namespace

Colour plasma(double share) {
  const double position = std::clamp(share, 0.0, 1.0) * (kPlasma.size() - 1);
  const auto index = std::min(static_cast<std::size_t>(position), kPlasma.size() - 2);
  return mix(kPlasma[index], kPlasma[index + 1],
             static_cast<float>(position - static_cast<double>(index)));
}

Colour stage_colour(int stage, int stages) {
  const double share = stages > 1 ? static_cast<double>(stage) / (stages - 1) : 0.0;
  return plasma(kPalestShare * share);
}

}  // namespace qsmpc
