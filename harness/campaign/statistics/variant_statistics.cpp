#include "harness/campaign/statistics/variant_statistics.hpp"

#include <cmath>

#include "harness/campaign/statistics/paired_difference.hpp"
#include "models/constants.hpp"

namespace qsmpc::harness {
namespace {

double share_of(double sum, std::int64_t count) {
  return count == 0 ? kNotANumber : sum / static_cast<double>(count);
}

}  // namespace

EpisodeRate episode_rate(std::int64_t events, std::int64_t trials) {
  if (trials == 0) return {};
  return {.events = events,
          .rate = static_cast<double>(events) / static_cast<double>(trials),
          .interval = clopper_pearson(events, trials, kCampaignTail)};
}

const std::vector<double>& spread_shares() {
  static const std::vector<double> shares = {0.0, 0.05, 0.25, 0.5, 0.75, 0.95, 1.0};
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

void VariantTally::add(const EpisodeRow& row) {
  ++done_;
  ++outcomes_[row.outcome];
  unsafe_ += row.unsafe ? 1 : 0;
  deadline_misses_ += row.timing.deadline_misses;
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

VariantStatistics VariantTally::result() const {
  const auto episodes_that = [&](Outcome outcome) {
    const auto found = outcomes_.find(outcome_name(outcome));
    return found == outcomes_.end() ? std::int64_t{0} : found->second;
  };
  return {.done = done_,
          .outcomes = outcomes_,
          .reached = episode_rate(episodes_that(Outcome::kReached), done_),
          .unsafe = episode_rate(unsafe_, done_),
          .fault = episode_rate(episodes_that(Outcome::kFault), done_),
          .deadline_misses = deadline_misses_,
          .periods = calibration_.periods(),
          .unsafe_periods = calibration_.unsafe(),
          .certified_periods = calibration_.certified(),
          .p_value = calibration_.p_value(),
          .calibration = calibration_.result(),
          .published = published_.result()};
}

}  // namespace qsmpc::harness
