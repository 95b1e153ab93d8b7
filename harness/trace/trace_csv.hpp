// An episode as comma-separated values, for spreadsheets and third-party viewers. All files share
// one timeline, in seconds.
#pragma once

#include <string>

#include "harness/trace/episode_view.hpp"

namespace qsmpc::harness {

/// One line per control instant: time, and, where available, true state, clearance, observation,
/// input, disturbance, residual, belief, cost and the certificate of the next state. Columns are
/// "NAME [UNIT]"; fields of unknown numbers are empty.
[[nodiscard]] std::string episode_csv(const EpisodeView& view);

/// One line per period and stage of its plan: the plan's nominal state and input, and the
/// certificate. Only the header if nothing is planned.
[[nodiscard]] std::string plan_csv(const EpisodeView& view);

/// One line per control instant and moving obstacle: its index among the scenario's obstacles, the
/// position of its centre, its rotation from its orientation in the scenario, and its measured
/// position. Only the header if nothing moves.
[[nodiscard]] std::string obstacles_csv(const EpisodeView& view);

/// One line per period, stage and particle: weight and location. Only the header without particles.
[[nodiscard]] std::string particles_csv(const EpisodeView& view);

}  // namespace qsmpc::harness
