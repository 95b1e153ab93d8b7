#include "harness/campaign/statistics/variant_statistics.hpp"

#include <algorithm>
#include <cmath>

#include "harness/campaign/statistics/paired_difference.hpp"
#include "harness/statistics/confidence_sequence.hpp"
#include "harness/trace/ending.hpp"
#include "models/constants.hpp"

namespace qsmpc::harness {
namespace {

double share_of(double sum, std::int64_t count) {
  return count == 0 ? kNotANumber : sum / static_cast<double>(count);
}

}  // namespace

EpisodeRate episode_rate(std::int64_t events, std::int64_t trials, Counted counted) {
  if (trials == 0) return {};
  return {.events = events,
          .rate = static_cast<double>(events) / static_cast<double>(trials),
          .interval = counted == Counted::kStopped
                          ? confidence_sequence(events, trials, 1.0 - 2.0 * kCampaignTail)
                          : clopper_pearson(events, trials, kCampaignTail)};
}

const std::vector<double>& spread_shares() {
  static const std::vector<double> shares = {0.0, 0.05, 0.25, 0.5, 0.75, 0.95, 1.0};
  return shares;
}

const std::vector<double>& curve_shares() {
  constexpr int kSteps = 40;
  static const std::vector<double> shares = [] {
    std::vector<double> all;
    for (int n = 0; n <= kSteps; ++n) all.push_back(static_cast<double>(n) / kSteps);
    return all;
  }();
  return shares;
}

const std::vector<std::string>& spread_names() {
  static const std::vector<std::string> names = {"min", "p5", "p25", "median", "p75", "p95", "max"};
  return names;
}

double VariantStatistics::unsafe_step_rate() const {
  return share_of(static_cast<double>(unsafe_periods), periods);
}

double VariantStatistics::certified_step_rate() const {
  return share_of(certified_periods, periods);
}

double VariantStatistics::believed_step_rate() const {
  return share_of(believed, believed_periods);
}

const std::vector<ListedOutcome>& listed_outcomes() {
  static const std::vector<ListedOutcome> listed = {
      {outcome_name(Outcome::kReached), "reached", "reached the target",
       &VariantStatistics::reached},
      {outcome_name(Outcome::kCollision), "collision", "collided", &VariantStatistics::collision},
      {outcome_name(Outcome::kLeftBounds), "left bounds", "left the bounds",
       &VariantStatistics::left_bounds},
      {outcome_name(Outcome::kTimeout), "timeout", "ran out of time", &VariantStatistics::timeout},
      {outcome_name(Outcome::kFault), "fault", "faulted", &VariantStatistics::fault}};
  return listed;
}

std::vector<ListedOutcome> outcomes_of(const std::vector<VariantStatistics>& variants) {
  std::vector<ListedOutcome> listed = listed_outcomes();
  const ListedOutcome former{kLeftSafeSet, "left safe set", "left the safe set",
                             &VariantStatistics::left_safe_set};
  if (std::ranges::any_of(variants, [&](const VariantStatistics& variant) {
        return (variant.*former.rate).events > 0;
      })) {
    listed.push_back(former);
  }
  return listed;
}

void VariantTally::add(const EpisodeRow& row) {
  ++done_;
  ++outcomes_[row.outcome];
  unsafe_ += row.unsafe ? 1 : 0;
  risk_exceeded_ += row.risk_exceeded.value_or(0) > 0 ? 1 : 0;
  deadline_misses_ += row.timing.deadline_misses;
  if (row.believed_sum) {
    ++believed_drives_;
    believed_periods_ += row.steps;
    believed_ += *row.believed_sum;
  }
  const bool compares = row.outcome != outcome_name(Outcome::kFault);
  const auto add_to = [&](SpreadTally& spread, double value) {
    if (compares && !std::isnan(value)) {
      spread.add(value);
    } else {
      spread.add_worst();
    }
  };
  add_to(cost_, row.cost);
  add_to(min_clearance_, row.min_clearance);
  add_to(time_to_target_, row.time_to_target.value_or(kNotANumber));
}

void VariantTally::add(std::int64_t period, const PeriodRow& row) {
  calibration_.add(period, row.certified, row.unsafe);
  published_.add(period, row.published, row.unsafe);
}

VariantStatistics VariantTally::result(Counted counted) const {
  const auto rate_of = [&](const char* outcome) {
    const auto found = outcomes_.find(outcome);
    return episode_rate(found == outcomes_.end() ? 0 : found->second, done_, counted);
  };
  return {.done = done_,
          .outcomes = outcomes_,
          .reached = rate_of(outcome_name(Outcome::kReached)),
          .collision = rate_of(outcome_name(Outcome::kCollision)),
          .left_bounds = rate_of(outcome_name(Outcome::kLeftBounds)),
          .timeout = rate_of(outcome_name(Outcome::kTimeout)),
          .fault = rate_of(outcome_name(Outcome::kFault)),
          .left_safe_set = rate_of(kLeftSafeSet),
          .unsafe = episode_rate(unsafe_, done_, counted),
          .risk_exceeded = risk_exceeded_,
          .deadline_misses = deadline_misses_,
          .periods = calibration_.periods(),
          .unsafe_periods = calibration_.unsafe(),
          .certified_periods = calibration_.certified(),
          .believed_drives = believed_drives_,
          .believed_periods = believed_periods_,
          .believed = believed_,
          .p_value = calibration_.p_value(),
          .calibration = calibration_.result(),
          .published = published_.result()};
}

}  // namespace qsmpc::harness
