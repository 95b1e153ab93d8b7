#include "harness/cluster/lease_source.hpp"

#include <utility>

namespace qsmpc::harness {

LeaseSource::LeaseSource(const LeasePlan& plan, const std::string& folder, LeaseQueue& queue,
                         Clock::duration pause)
    : plan_(plan), folder_(folder), queue_(queue), seed_end_(plan.seeds.size()), pause_(pause) {
  if (const auto& until = plan.identity.campaign.until) {
    rule_.emplace(*until, plan.identity.variants.size(), plan.seeds.size());
  }
}

std::optional<EpisodeTask> LeaseSource::next(const std::function<bool()>& stopped) {
  // Polling interval of `stopped` while there is nothing to do.
  constexpr auto kLongestWait = std::chrono::milliseconds(100);
  std::unique_lock lock(mutex_);
  while (!stopped()) {
    if (error_) std::rethrow_exception(error_);
    if (const auto task = next_of_open()) return task;
    if (Clock::now() >= next_look_) {
      if (rule_) ask_rule();
      if (const auto lease = queue_.claim()) {
        open(*lease);
        continue;
      }
      if (queue_.all_finished()) return std::nullopt;
      next_look_ = Clock::now() + pause_;
    }
    changed_.wait_for(lock, std::min<Clock::duration>(pause_, kLongestWait));
  }
  return std::nullopt;
}

/// All variants of a seed come before the next seed.
std::optional<EpisodeTask> LeaseSource::next_of_open() {
  const auto variants = static_cast<std::int64_t>(plan_.identity.variants.size());
  for (auto& [lease, open] : open_) {
    if (open.begun == std::ssize(open.seeds) * variants) continue;
    const EpisodeTask task{.variant = static_cast<std::size_t>(open.begun % variants),
                           .seed_index = plan_.first_seed_of(lease) + open.begun / variants};
    if (!is_wanted(task)) continue;
    ++open.begun;
    return task;
  }
  return std::nullopt;
}

void LeaseSource::open(std::int64_t lease) {
  const std::size_t variants = plan_.identity.variants.size();
  OpenLease& open = open_[lease];
  open = {};
  for (std::int64_t n = 0; n < plan_.seeds_of(lease); ++n) {
    open.seeds.push_back({.seed_index = plan_.first_seed_of(lease) + n,
                          .outcomes = std::vector<std::string>(variants),
                          .unsafe = std::vector<bool>(variants)});
  }
  changed_.notify_all();
}

/// Feeds the rule with the leases finished since the last call.
void LeaseSource::ask_rule() {
  for (const std::int64_t lease : finished_leases(folder_)) {
    if (!told_.insert(lease).second) continue;
    for (const SeedOutcomes& seed : finished_outcomes(folder_, lease)) {
      for (std::size_t n = 0; n < seed.outcomes.size(); ++n) {
        rule_->add(seed.seed_index, n,
                   is_stop_event(*plan_.identity.campaign.until, seed.outcomes[n], seed.unsafe[n]));
      }
    }
  }
  const std::optional<std::int64_t> seeds = rule_->stops_after();
  if (!seeds) return;
  seed_end_ = *seeds;
  queue_.need(plan_.leases_of(*seeds));
}

void LeaseSource::stored(const EpisodeTask& task, const EpisodeRow& row) {
  const std::lock_guard lock(mutex_);
  const std::int64_t lease = task.seed_index / plan_.lease_seeds;
  OpenLease& open = open_.at(lease);
  SeedOutcomes& seed =
      open.seeds.at(static_cast<std::size_t>(task.seed_index - plan_.first_seed_of(lease)));
  seed.outcomes.at(task.variant) = row.outcome;
  seed.unsafe.at(task.variant) = row.unsafe;
  ++open.stored;
  if (open.stored < std::ssize(open.seeds) * std::ssize(seed.outcomes)) return;
  queue_.finish(lease, open.seeds);
  open_.erase(lease);
  next_look_ = {};  // all leases may be finished now: look at once
  changed_.notify_all();
}

void LeaseSource::fail(std::exception_ptr error) {
  const std::lock_guard lock(mutex_);
  if (!error_) error_ = std::move(error);
  changed_.notify_all();
}

bool LeaseSource::has_failed() const {
  const std::lock_guard lock(mutex_);
  return error_ != nullptr;
}

void LeaseSource::rethrow_failure() const {
  const std::lock_guard lock(mutex_);
  if (error_) std::rethrow_exception(error_);
}

}  // namespace qsmpc::harness
