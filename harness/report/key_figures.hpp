// The numbers that an episode is judged by, as HTML that says what each of them is.
#pragma once

#include <string>

#include "harness/trace/episode_view.hpp"
#include "models/dynamics/dynamics.hpp"

namespace qsmpc::harness {

/// How the episode ended, in one sentence, with the simulator's words where it broke.
[[nodiscard]] std::string outcome_html(const EpisodeView& view);

/// The key numbers as a list of tiles.
[[nodiscard]] std::string key_figures_html(const EpisodeView& view);

/// The plant's one-step mismatch as a table, a state a row; a sentence where there is none.
[[nodiscard]] std::string mismatch_html(const EpisodeView& view);

}  // namespace qsmpc::harness
