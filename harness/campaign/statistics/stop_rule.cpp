#include "harness/campaign/statistics/stop_rule.hpp"

#include <algorithm>
#include <stdexcept>

#include "harness/statistics/confidence_sequence.hpp"
#include "harness/trace/ending.hpp"

namespace qsmpc::harness {

const std::vector<std::string>& stop_event_names() {
  static const std::vector<std::string> names{kUnsafeEvent,
                                              outcome_name(Outcome::kReached),
                                              outcome_name(Outcome::kCollision),
                                              outcome_name(Outcome::kLeftBounds),
                                              outcome_name(Outcome::kTimeout),
                                              outcome_name(Outcome::kFault)};
  return names;
}

bool is_stop_event(const StopCriterion& criterion, const std::string& outcome, bool unsafe) {
  return criterion.of == kUnsafeEvent ? unsafe : criterion.of == outcome;
}

StopRule::StopRule(const StopCriterion& criterion, std::size_t variants, std::int64_t seeds)
    : criterion_(criterion), seeds_(seeds), events_(variants) {
  if (variants == 0) throw std::invalid_argument("stop rule: no variant");
}

void StopRule::add(std::int64_t seed_index, std::size_t variant, bool event) {
  if (seed_index < 0 || seed_index >= seeds_ || variant >= events_.size()) {
    throw std::invalid_argument("stop rule: a seed or variant that the campaign does not have");
  }
  if (stops_after_ || seed_index < complete_) return;
  std::vector<Known>& known = ahead_[seed_index];
  known.resize(events_.size(), Known::kNot);
  if (known[variant] == Known::kNot) known[variant] = event ? Known::kEvent : Known::kOther;
  take_complete();
}

RateInterval StopRule::interval(std::size_t variant) const {
  return confidence_sequence(events_.at(variant), complete_, criterion_.confidence);
}

bool StopRule::is_wide(std::size_t variant) const {
  const RateInterval interval = this->interval(variant);
  return interval.upper - interval.lower > 2.0 * criterion_.rate_halfwidth;
}

/// Counts the seeds whose episodes are all known, and stops as soon as they suffice.
void StopRule::take_complete() {
  while (!stops_after_ && !ahead_.empty() && ahead_.begin()->first == complete_) {
    const std::vector<Known>& known = ahead_.begin()->second;
    if (std::ranges::find(known, Known::kNot) != known.end()) return;
    for (std::size_t v = 0; v < known.size(); ++v) events_[v] += known[v] == Known::kEvent ? 1 : 0;
    ahead_.erase(ahead_.begin());
    ++complete_;
    // An interval that was too wide one seed ago most likely still is.
    if (is_wide(wide_)) continue;
    wide_ = 0;
    while (wide_ < events_.size() && !is_wide(wide_)) ++wide_;
    if (wide_ < events_.size()) continue;
    stops_after_ = complete_;
    ahead_.clear();
  }
}

}  // namespace qsmpc::harness
