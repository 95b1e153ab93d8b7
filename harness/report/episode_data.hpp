// What the scripts of an episode's page move: the drive period by period, as JSON.
#pragma once

#include <string>
#include <vector>

#include "harness/figures/plane_map.hpp"
#include "harness/figures/svg_chart.hpp"
#include "harness/trace/episode_view.hpp"
#include "models/dynamics/dynamics.hpp"

namespace qsmpc::harness {

/// The page's parts that the scripts take up.
struct PageScene {
  const std::vector<Chart>& charts;  ///< in the order of the page
  const PlaneMap* map = nullptr;     ///< null for a system without a place in the plane
  double video_from = 0.0;           ///< s of the drive, where the video begins
  double video_speed = 1.0;          ///< s of the drive in a second of the video
};

/// A JSON object that is safe inside of a <script type="application/json">. Rows of numbers are
/// packed (packed_numbers.hpp); web/data.js says what each means. Where all periods together have
/// more particles than a page should hold, every n-th of a stage is left, and "particles.stride"
/// is n.
[[nodiscard]] std::string episode_data(const EpisodeView& view, const PageScene& scene);

}  // namespace qsmpc::harness
