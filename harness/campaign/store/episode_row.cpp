#include "harness/campaign/store/episode_row.hpp"

#include <cstddef>

#include <fmt/format.h>

#include "controller/planning/safe_set.hpp"
#include "harness/trace/residuals.hpp"
#include "harness/trace/summary.hpp"

namespace qsmpc::harness {
namespace {

std::vector<PeriodRow> period_rows(const Trace& trace) {
  std::vector<PeriodRow> rows;
  const Eigen::MatrixXd states = true_states(trace);
  const Eigen::Index periods = completed_periods(trace);
  for (Eigen::Index k = 0; k < periods; ++k) {
    const StepRecord& step = trace.steps[static_cast<std::size_t>(k)];
    const controller::StageCertificate& next = step.certificates.front();
    rows.push_back(
        {.certified = next.value,
         .published = next.thesis,
         .unsafe = controller::clearance(states.col(k + 1), trace.scenario.safe_set) <= 0.0,
         .ocp_ms = step.timing.total});
  }
  return rows;
}

}  // namespace

EpisodeRow episode_row(const Trace& trace, std::int64_t variant) {
  const Summary summary = summarise(trace);
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
          .iterations_median = summary.iterations_median,
          .fallbacks = summary.fallbacks,
          .version = summary.version,
          .timing = {.deadline_misses = summary.deadline_misses},
          .periods = period_rows(trace)};
}

std::string episode_folder(std::int64_t variant, std::uint64_t seed) {
  return fmt::format("episodes/{}/{}", variant, seed);
}

bool is_failure(const EpisodeRow& row) {
  return row.outcome != outcome_name(Outcome::kReached) || row.unsafe;
}

}  // namespace qsmpc::harness
