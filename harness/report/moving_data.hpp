// The moving obstacles as data for the scripts of an episode's page.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "harness/trace/driven_obstacles.hpp"
#include "harness/trace/episode_view.hpp"

namespace qsmpc::harness {

/// web/data.js documents the meaning of each number. If there are very many forecasts, fewer stages
/// are kept, down to the first and the last, and beyond that none: then "stages" is empty.
[[nodiscard]] nlohmann::ordered_json moving_data(const EpisodeView& view,
                                                 const DrivenObstacles& others);

}  // namespace qsmpc::harness
