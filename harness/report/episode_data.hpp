// The data that the scripts of an episode's page animate: the drive period by period, as JSON.
#pragma once

#include <string>
#include <vector>

#include "harness/figures/plane_map.hpp"
#include "harness/figures/svg_chart.hpp"
#include "harness/trace/episode_view.hpp"
#include "models/dynamics/dynamics.hpp"

namespace qsmpc::harness {

/// The parts of the page that the scripts use.
struct PageScene {
  const std::vector<Chart>& charts;  ///< in the order of the page
  const PlaneMap* map = nullptr;     ///< null for a system without a position in the plane
  double video_from = 0.0;           ///< time of the drive at which the video begins, s
  double video_speed = 1.0;          ///< seconds of the drive per second of video
};

/// A JSON object that is safe inside a <script type="application/json">. Rows of numbers are packed
/// (packed_numbers.hpp); web/data.js documents their meaning. If all periods together have more
/// particles than a page should hold, only every n-th of a stage is kept, and "particles.stride" is
/// n.
[[nodiscard]] std::string episode_data(const EpisodeView& view, const PageScene& scene);

}  // namespace qsmpc::harness
