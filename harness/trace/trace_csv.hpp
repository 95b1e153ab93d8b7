// An episode as comma-separated values, for spreadsheets and other people's viewers: all files on
// one timeline, whose unit is the second.
#pragma once

#include <string>

#include "harness/trace/episode_view.hpp"

namespace qsmpc::harness {

/// A line a control instant: time, and true state, clearance, observation, input, disturbance,
/// residual, belief, cost and what is certified of the next state, as far as there are any. Columns
/// are "NAME [UNIT]"; fields of numbers that are not known are empty.
[[nodiscard]] std::string episode_csv(const EpisodeView& view);

/// A line a period and stage of its plan: the plan's nominal state and input, and the certificate.
/// The head alone where nothing is planned.
[[nodiscard]] std::string plan_csv(const EpisodeView& view);

/// A line a control instant and obstacle that moves: its index among the scenario's obstacles,
/// where its middle is, its turn from how it is written, and where it was seen to be. The head
/// alone where nothing moves.
[[nodiscard]] std::string obstacles_csv(const EpisodeView& view);

/// A line a period, stage and particle: weight and location. The head alone without particles.
[[nodiscard]] std::string particles_csv(const EpisodeView& view);

}  // namespace qsmpc::harness
