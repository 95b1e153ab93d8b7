// The head-up display of an episode: rows and strip charts.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "harness/trace/episode_view.hpp"
#include "render/frame.hpp"

namespace qsmpc::harness {

/// Ranges of an episode's strip charts, the same in all its frames.
struct ChartRanges {
  double time = 0.0;                ///< longest history that a chart must hold, s
  double least_certificate = 1e-2;  ///< a power of ten
  double least_cost = 0.0;          ///< of a plan; a power of ten if all are positive, else 0
  double largest_cost = 1.0;
  double largest_solve_time = 1.0;  ///< ms
};

/// The ranges that cover the whole episode.
[[nodiscard]] ChartRanges chart_ranges(const EpisodeView& view);

/// The ranges that cover both, for episodes shown side by side.
[[nodiscard]] ChartRanges united(const ChartRanges& a, const ChartRanges& b);

/// A probability formatted for people, e.g. "35 %", "0.02 %", "10⁻⁶ %".
[[nodiscard]] std::string percent_text(double probability);

/// An upper bound of a probability: "≤ 35 %", two digits, rounded up, and not below 0.001 %; "–"
/// for NaN.
[[nodiscard]] std::string bound_text(double bound);

/// Histories up to step `step` of the certificate, the first input, the plan's cost, the planning
/// time against its deadline (without one: the control period), and the second input. They hold up
/// to 20 s; longer episodes scroll.
[[nodiscard]] std::vector<render::StripChart> strip_charts(const EpisodeView& view,
                                                           const ChartRanges& ranges,
                                                           std::size_t step);

/// Time (s), speed (m/s), the bound for the whole plan of step `step`; if there are risk limits,
/// whether they are exceeded and how much of the mission's is spent; and whether the previous plan
/// was applied instead.
[[nodiscard]] std::vector<render::HudRow> hud_rows(const Trace& trace, std::size_t step,
                                                   double time, double speed);

}  // namespace qsmpc::harness
