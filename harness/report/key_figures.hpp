// The key figures of an episode as HTML, with an explanation of each.
#pragma once

#include <string>

#include "harness/trace/episode_view.hpp"

namespace qsmpc::harness {

struct KeyFigures {
  std::string outcome;   ///< how the episode ended, with the simulator's message if it failed
  std::string tiles;     ///< the key numbers as a list
  std::string mismatch;  ///< the plant's one-step mismatch as a table, one row per state
};

[[nodiscard]] KeyFigures key_figures(const EpisodeView& view);

}  // namespace qsmpc::harness
