#include "render/scene/thinning.hpp"

#include <algorithm>
#include <numeric>
#include <vector>

namespace qsmpc::render {

std::size_t thinning(std::size_t points, std::size_t limit) {
  return std::max<std::size_t>((points + limit - 1) / limit, 1);
}

ParticleStage thinned(const ParticleStage& stage, std::size_t every) {
  const std::size_t count = std::min(stage.points.size(), stage.weights.size());
  if (every <= 1 || count == 0) {
    return stage;
  }
  std::vector<std::size_t> order(count);
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&stage](std::size_t a, std::size_t b) {
    return stage.weights[a] > stage.weights[b];
  });
  ParticleStage kept;
  // Starts in the middle of the first n; otherwise the points kept would be heavier than those left
  // out. Of fewer points one is kept.
  const std::size_t first = std::min((every - 1) / 2, count - 1);
  for (std::size_t i = first; i < count; i += every) {
    kept.points.push_back(stage.points[order[i]]);
    kept.weights.push_back(stage.weights[order[i]]);
  }
  const double all = std::accumulate(stage.weights.begin(), stage.weights.end(), 0.0);
  const double rest = std::accumulate(kept.weights.begin(), kept.weights.end(), 0.0);
  for (double& weight : kept.weights) {
    weight *= rest > 0.0 ? all / rest : 1.0;
  }
  return kept;
}

}  // namespace qsmpc::render
