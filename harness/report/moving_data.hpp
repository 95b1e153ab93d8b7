// The obstacles that move, as the scripts of an episode's page have them.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "harness/trace/driven_obstacles.hpp"
#include "harness/trace/episode_view.hpp"

namespace qsmpc::harness {

/// web/data.js says what each number means. Of very many forecasts fewer stages are left, down to
/// the first and the last, and beyond that none: then "stages" is empty.
[[nodiscard]] nlohmann::ordered_json moving_data(const EpisodeView& view,
                                                 const DrivenObstacles& others);

}  // namespace qsmpc::harness
