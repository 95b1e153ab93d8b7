// The numbers that an episode is judged by, as HTML that says what each of them is.
#pragma once

#include <string>

#include "harness/trace/episode_view.hpp"

namespace qsmpc::harness {

struct KeyFigures {
  std::string outcome;   ///< how the episode ended, with the simulator's words where it broke
  std::string tiles;     ///< the key numbers as a list
  std::string mismatch;  ///< the plant's one-step mismatch as a table, a state a row
};

[[nodiscard]] KeyFigures key_figures(const EpisodeView& view);

}  // namespace qsmpc::harness
