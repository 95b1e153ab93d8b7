#include "harness/contest/standing_tally.hpp"

#include <cmath>

#include "harness/statistics/sign_test.hpp"
#include "harness/trace/ending.hpp"

namespace qsmpc::harness {
namespace {

// Tolerance of sums of shares over seeds: shares such as 1/3 are not exact in floating point.
constexpr double kShareRounding = 1e-9;

/// The counted events of a drive, in the order of Standing's rates.
enum Event : std::size_t {
  kReachedDrive,
  kCollided,
  kLeft,
  kTimedOut,
  kFaulted,
  kUnsafeDrive,
  kKept,
  kPromised
};

bool reached(const EpisodeRow& row) { return !is_failure(row); }

bool has(const EpisodeRow& row, std::size_t event, const std::optional<double>& risk_limit) {
  switch (event) {
    case kReachedDrive:
      return reached(row);
    case kCollided:
      return row.outcome == outcome_name(Outcome::kCollision);
    case kLeft:
      return row.outcome == outcome_name(Outcome::kLeftBounds);
    case kTimedOut:
      return row.outcome == outcome_name(Outcome::kTimeout);
    case kFaulted:
      return row.outcome == outcome_name(Outcome::kFault);
    case kKept:
      return risk_limit && is_certified_within(row, *risk_limit);
    case kPromised:
      return risk_limit && is_planned_within(row, *risk_limit);
    default:
      return row.unsafe;
  }
}

DriveMean drive_mean(const BootstrapMean& mean) {
  return {.drives = mean.count(), .mean = mean.mean(), .interval = mean.interval()};
}

}  // namespace

void StandingTally::add(const EpisodeRow& row, const Eigen::ArrayXd& weights) {
  SeedCounts& seed = seeds_[row.seed];
  ++seed.drives;
  for (std::size_t event = 0; event < kCounted; ++event) {
    seed.events[event] += has(row, event, risk_limit_);
  }
  if (row.believed_sum && std::isfinite(*row.believed_sum)) {
    believed_.add(*row.believed_sum, weights);
  }
  if (std::isfinite(row.next_step_sum)) certified_.add(row.next_step_sum, weights);
  if (reached(row) && std::isfinite(row.cost)) cost_.add(row.cost, weights);
}

/// Clopper–Pearson limits with one trial per seed. The share of a seed's drives with the event
/// counts as a fraction of an event; the sum is rounded outwards. The limits are exact where each
/// seed has one drive or all of its drives end alike; otherwise a share varies less than a single
/// event does.
EpisodeRate StandingTally::rate_of(std::size_t event) const {
  std::int64_t events = 0;
  std::int64_t drives = 0;
  double shares = 0.0;
  for (const auto& [seed, counts] : seeds_) {
    events += counts.events[event];
    drives += counts.drives;
    shares += static_cast<double>(counts.events[event]) / static_cast<double>(counts.drives);
  }
  if (drives == 0) return {};
  const auto trials = static_cast<std::int64_t>(seeds_.size());
  const auto least = static_cast<std::int64_t>(std::floor(shares + kShareRounding));
  const auto most = static_cast<std::int64_t>(std::ceil(shares - kShareRounding));
  return {.events = events,
          .rate = static_cast<double>(events) / static_cast<double>(drives),
          .interval = {.lower = clopper_pearson(least, trials, kCampaignTail).lower,
                       .upper = clopper_pearson(most, trials, kCampaignTail).upper}};
}

Standing StandingTally::result() const {
  Standing standing{.reached = rate_of(kReachedDrive),
                    .collision = rate_of(kCollided),
                    .left_bounds = rate_of(kLeft),
                    .timeout = rate_of(kTimedOut),
                    .fault = rate_of(kFaulted),
                    .unsafe = rate_of(kUnsafeDrive),
                    .believed = drive_mean(believed_),
                    .certified = drive_mean(certified_),
                    .cost = drive_mean(cost_)};
  if (risk_limit_) {
    standing.kept = rate_of(kKept);
    standing.promised = rate_of(kPromised);
  }
  for (const auto& [seed, counts] : seeds_) standing.drives += counts.drives;
  return standing;
}

void VersusTally::Share::add(bool reference, bool own, std::uint64_t seed,
                             const Eigen::ArrayXd& weights) {
  mean.add(static_cast<double>(own) - static_cast<double>(reference), weights);
  more[seed] += static_cast<std::int64_t>(own) - static_cast<std::int64_t>(reference);
}

ShareDifference VersusTally::Share::result() const {
  ShareDifference difference{
      .pairs = mean.count(), .mean = mean.mean(), .interval = mean.interval()};
  for (const auto& [seed, count] : more) {
    difference.higher += count > 0 ? 1 : 0;
    difference.lower += count < 0 ? 1 : 0;
  }
  difference.p_value = sign_test_p_value(difference.higher, difference.lower);
  return difference;
}

void VersusTally::add(const EpisodeRow& reference, const EpisodeRow& row, std::size_t cell,
                      const Eigen::ArrayXd& weights) {
  reached_.add(reached(reference), reached(row), row.seed, weights);
  unsafe_.add(reference.unsafe, row.unsafe, row.seed, weights);
  if (!reached(reference) || !reached(row)) return;
  if (!std::isfinite(reference.cost) || !std::isfinite(row.cost)) return;
  cost_.add(row.cost - reference.cost, weights);
  CellCosts& costs = costs_[cell];
  costs.own += row.cost;
  costs.reference += reference.cost;
  costs.owns += row.cost * weights;
  costs.references += reference.cost * weights;
}

CostDifference VersusTally::cost() const {
  CostDifference difference{
      .pairs = cost_.count(), .mean = cost_.mean(), .interval = cost_.interval()};
  RunningMean ratio;
  for (const auto& [cell, costs] : costs_) {
    if (costs.reference > 0.0) ratio.add(costs.own / costs.reference);
  }
  difference.ratio = ratio.mean();
  std::vector<double> replicates;
  for (Eigen::Index r = 0; difference.pairs > 1 && r < kBootstrapReplicates; ++r) {
    RunningMean replicate;
    for (const auto& [cell, costs] : costs_) {
      // With few pairs, a replicate may contain none of them.
      if (costs.references[r] > 0.0) replicate.add(costs.owns[r] / costs.references[r]);
    }
    if (replicate.count() > 0) replicates.push_back(replicate.mean());
  }
  difference.ratio_interval = percentile_interval(std::move(replicates));
  return difference;
}

Versus VersusTally::result() const {
  return {.reached = reached_.result(), .unsafe = unsafe_.result(), .cost = cost()};
}

}  // namespace qsmpc::harness
