#include "harness/campaign/store/episode_row.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>

#include <fmt/format.h>

#include "harness/trace/map_axes.hpp"
#include "harness/trace/summary.hpp"

namespace qsmpc::harness {
namespace {

std::vector<PeriodRow> period_rows(const EpisodeView& view) {
  std::vector<PeriodRow> rows;
  for (Eigen::Index k = 0; k < view.periods(); ++k) {
    const StepRecord& step = view.trace().steps[static_cast<std::size_t>(k)];
    const controller::StageCertificate& next = step.certificates.front();
    rows.push_back({.certified = next.value,
                    .published = next.of("thesis"),
                    .unsafe = view.ended_unsafe(k),
                    .ocp_ms = step.timing.total});
  }
  return rows;
}

/// Rounds to the digits that the store keeps, which suffice for a plot.
double stored(double value) { return std::stod(fmt::format("{:.6g}", value)); }

std::vector<PathPoint> path_of(const EpisodeView& view) {
  const Eigen::MatrixXd& states = view.states();
  const std::optional<MapAxes> axes = map_axes(view.system());
  if (!axes || states.rows() <= std::max(axes->x, axes->y)) return {};
  const auto count = static_cast<std::size_t>(states.cols());
  constexpr std::size_t kSteps = kMostPathPoints - 1;  // one point is reserved for the end
  const std::size_t stride = std::max<std::size_t>(1, (count + kSteps - 2) / kSteps);
  std::vector<PathPoint> path;
  const auto add = [&](std::size_t k) {
    const auto state = states.col(static_cast<Eigen::Index>(k));
    const double x = state[axes->x];
    const double y = state[axes->y];
    if (std::isfinite(x) && std::isfinite(y)) path.push_back({.x = stored(x), .y = stored(y)});
  };
  for (std::size_t k = 0; k + 1 < count; k += stride) add(k);
  if (count > 0) add(count - 1);
  return path;
}

}  // namespace

EpisodeRow episode_row(const EpisodeView& view, std::int64_t variant) {
  const Summary& summary = view.summary();
  std::optional<double> believed_max;
  std::optional<double> believed_sum;
  if (summary.believed) {
    believed_max = summary.believed->max;
    believed_sum = summary.believed->sum;
  }
  return {.variant = variant,
          .seed = summary.seed,
          .outcome = summary.outcome,
          .fault = summary.fault,
          .steps = summary.steps,
          .time_to_target = summary.time_to_target,
          .unsafe = summary.collision,
          .min_clearance = summary.min_clearance,
          .cost = summary.closed_loop_cost,
          .next_step_max = summary.next_step_max,
          .next_step_sum = summary.next_step_sum,
          .horizon_max = summary.horizon_max,
          .thesis_max = summary.thesis_max,
          .believed_max = believed_max,
          .believed_sum = believed_sum,
          .iterations_median = summary.iterations_median,
          .fallbacks = summary.fallbacks,
          .risk_exceeded = summary.risk.exceeded_periods,
          .version = summary.version,
          .timing = {.deadline_misses = summary.deadline_misses},
          .periods = period_rows(view),
          .path = path_of(view)};
}

std::string episode_folder(std::int64_t variant, std::uint64_t seed) {
  return fmt::format("episodes/{}/{}", variant, seed);
}

bool is_failure(const EpisodeRow& row) {
  return row.outcome != outcome_name(Outcome::kReached) || row.unsafe;
}

bool is_certified_within(const EpisodeRow& row, double limit) {
  return !is_failure(row) && row.next_step_sum <= limit;
}

bool is_planned_within(const EpisodeRow& row, double limit) {
  return !is_failure(row) && row.horizon_max <= limit;
}

}  // namespace qsmpc::harness
