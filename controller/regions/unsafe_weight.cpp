#include "controller/regions/unsafe_weight.hpp"

#include <algorithm>
#include <cstddef>

namespace qsmpc::controller {

double unsafe_weight(const DiscreteMeasure& measure, const UnsafeSet& unsafe, Eigen::Index stage,
                     UnsafeWeightScratch& workspace) {
  const Eigen::Index count = measure.size();
  std::vector<char>& is_unsafe = workspace.is_unsafe;
  is_unsafe.assign(static_cast<std::size_t>(count), 0);
  for (const DiscView& disc : unsafe.discs()) {
    disc.placement.of(measure.locations, {.begin = 0, .end = count}, workspace.centres);
    for (Eigen::Index i = 0; i < count; ++i) {
      char& found = is_unsafe[static_cast<std::size_t>(i)];
      if (found != 0) continue;
      workspace.centre = workspace.centres.col(i);
      found = !workspace.centre.allFinite() ||
              std::ranges::any_of(disc.regions, [&](const RegionPointer& region) {
                return region->signed_distance(stage, workspace.centre) <= 0.0;
              });
    }
  }
  double weight = 0.0;
  for (Eigen::Index i = 0; i < count; ++i) {
    if (is_unsafe[static_cast<std::size_t>(i)] != 0) weight += measure.weights[i];
  }
  return std::min(weight, 1.0);  // the weights' sum is rounded
}

}  // namespace qsmpc::controller
