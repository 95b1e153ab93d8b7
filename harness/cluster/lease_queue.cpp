#include "harness/cluster/lease_queue.hpp"

#include <algorithm>
#include <iterator>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "harness/cluster/lease_plan.hpp"
#include "harness/cluster/shared_files.hpp"
#include "harness/errors.hpp"
#include "harness/files/atomic_file.hpp"
#include "harness/text/json_text.hpp"
#include "harness/text/number_parse.hpp"

namespace qsmpc::harness {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::string_view kFinishedEnding = ".json";
// Claims have a fixed length, so that rewriting them needs no space on a full disk.
constexpr std::size_t kClaimBytes = 512;

std::string claim_path(const std::string& folder, std::int64_t lease, std::int64_t generation) {
  return fmt::format("{}/{}.{}", cluster_path(folder, kClaimsFolder), lease, generation);
}

std::string finished_path(const std::string& folder, std::int64_t lease) {
  return fmt::format("{}/{}{}", cluster_path(folder, kFinishedFolder), lease, kFinishedEnding);
}

std::string claim_text(const LeaseHolder& holder, std::int64_t beats, bool given_back) {
  const Json json = {{"task", holder.task},       {"start", holder.start},
                     {"launch", holder.launch},   {"host", holder.host},
                     {"process", holder.process}, {"beat", beats},
                     {"given_back", given_back}};
  std::string text = compact_json_text(json);
  if (text.size() + 1 < kClaimBytes) text.resize(kClaimBytes - 1, ' ');
  return text + "\n";
}

/// Nothing if the claim is only partly written.
std::optional<LeaseClaim> claim_of(const std::string& text) {
  const Json json = Json::parse(text, nullptr, false);
  try {
    return LeaseClaim{.holder = {.task = json.at("task"),
                                 .start = json.at("start"),
                                 .launch = json.at("launch"),
                                 .host = json.at("host"),
                                 .process = json.at("process")},
                      .given_back = json.at("given_back")};
  } catch (const Json::exception&) {
    return std::nullopt;
  }
}

/// The highest claim generation of each lease.
std::map<std::int64_t, std::int64_t> latest_generations(const std::string& folder) {
  std::map<std::int64_t, std::int64_t> latest;
  for (const std::string& name : names_in_folder(cluster_path(folder, kClaimsFolder))) {
    const std::string_view text = name;
    const std::size_t dot = text.find('.');
    if (dot == std::string_view::npos) continue;
    const auto lease = parse_integer<std::int64_t>(text.substr(0, dot));
    const auto generation = parse_integer<std::int64_t>(text.substr(dot + 1));
    if (!lease || !generation) continue;
    const auto [entry, is_new] = latest.try_emplace(*lease, *generation);
    if (!is_new) entry->second = std::max(entry->second, *generation);
  }
  return latest;
}

}  // namespace

std::vector<LeaseClaim> open_claims(const std::string& folder) {
  const std::map<std::int64_t, std::int64_t> latest = latest_generations(folder);
  const std::set<std::int64_t> finished = finished_leases(folder);
  std::vector<LeaseClaim> claims;
  for (const auto& [lease, generation] : latest) {
    if (finished.contains(lease)) continue;
    const auto text = read_shared_file(claim_path(folder, lease, generation));
    std::optional<LeaseClaim> claim = text ? claim_of(*text) : std::nullopt;
    if (!claim) continue;
    claim->lease = lease;
    claim->generation = generation;
    claims.push_back(*std::move(claim));
  }
  return claims;
}

std::set<std::int64_t> finished_leases(const std::string& folder) {
  std::set<std::int64_t> leases;
  for (const std::string& name : names_in_folder(cluster_path(folder, kFinishedFolder))) {
    const std::string_view text = name;
    if (!text.ends_with(kFinishedEnding)) continue;
    const auto lease =
        parse_integer<std::int64_t>(text.substr(0, text.size() - kFinishedEnding.size()));
    if (lease) leases.insert(*lease);
  }
  return leases;
}

std::vector<SeedOutcomes> finished_outcomes(const std::string& folder, std::int64_t lease) {
  const std::string path = finished_path(folder, lease);
  const std::optional<std::string> text = read_shared_file(path);
  if (!text) throw IoError(path + ": has disappeared");
  try {
    std::vector<SeedOutcomes> seeds;
    const Json json = Json::parse(*text);
    for (const Json& seed : json.at("seeds")) {
      seeds.push_back({.seed_index = seed.at("index"),
                       .outcomes = seed.at("outcomes"),
                       .unsafe = seed.at("unsafe")});
    }
    return seeds;
  } catch (const Json::exception& error) {
    throw IoError(path + ": cannot be read: " + error.what());
  }
}

LeaseQueue::LeaseQueue(std::string folder, Options options)
    : folder_(std::move(folder)), options_(std::move(options)), needed_(options_.leases) {}

std::optional<std::int64_t> LeaseQueue::claim() {
  const std::lock_guard lock(mutex_);
  if (auto lease = claim_fresh()) return lease;
  return claim_again();
}

void LeaseQueue::need(std::int64_t leases) {
  const std::lock_guard lock(mutex_);
  needed_ = std::min(needed_, leases);
}

bool LeaseQueue::all_finished() const {
  const std::lock_guard lock(mutex_);
  return all_finished_;
}

/// Creates the claim of a generation, unless another task has created it; returns whether it did.
bool LeaseQueue::take(std::int64_t lease, std::int64_t generation) {
  const std::string text = claim_text(options_.me, ++beats_, false);
  if (!create_shared_file(claim_path(folder_, lease, generation), text)) return false;
  held_[lease] = generation;
  watched_.erase(lease);
  return true;
}

/// Claims the lowest lease that was never claimed. A claim is never removed, so leases seen as
/// claimed are not tried again.
std::optional<std::int64_t> LeaseQueue::claim_fresh() {
  if (!claimed_) {
    claimed_.emplace();
    for (const auto& [lease, generation] : latest_generations(folder_)) claimed_->insert(lease);
  }
  while (next_fresh_ < needed_) {
    const std::int64_t lease = next_fresh_++;
    if (!claimed_->contains(lease) && take(lease, 0)) return lease;
  }
  return std::nullopt;
}

std::optional<std::int64_t> LeaseQueue::claim_again() {
  // `finished` is read last, so that a lease finished in between is recognised. One finished even
  // later is at worst driven once more, in vain.
  const std::map<std::int64_t, std::int64_t> latest = latest_generations(folder_);
  const std::set<std::int64_t> finished = finished_leases(folder_);
  all_finished_ = std::distance(finished.begin(), finished.lower_bound(needed_)) == needed_;
  for (std::int64_t lease = 0; lease < needed_; ++lease) {
    if (finished.contains(lease) || held_.contains(lease)) continue;
    const auto claim = latest.find(lease);
    const std::int64_t generation = claim == latest.end() ? -1 : claim->second;
    if ((generation < 0 || is_lost(lease, generation)) && take(lease, generation + 1)) return lease;
  }
  return std::nullopt;
}

/// Whether no task drives the unfinished lease any more.
bool LeaseQueue::is_lost(std::int64_t lease, std::int64_t generation) {
  const auto text = read_shared_file(claim_path(folder_, lease, generation));
  if (!text) return false;
  const LeaseHolder& me = options_.me;
  if (const std::optional<LeaseClaim> claim = claim_of(*text)) {
    const LeaseHolder& holder = claim->holder;
    const bool is_before_me = holder.task == me.task && holder.start < me.start;
    if (claim->given_back || holder.launch < me.launch || is_before_me) return true;
  }
  const Clock::time_point now = options_.now();
  Watch& watch = watched_[lease];
  if (watch.generation != generation || watch.content != *text ||
      watch.since == Clock::time_point{}) {
    watch = {.generation = generation, .content = *text, .since = now};
    return false;
  }
  return now - watch.since >= options_.lost_after;
}

void LeaseQueue::finish(std::int64_t lease, const std::vector<SeedOutcomes>& outcomes) {
  Json seeds = Json::array();
  for (const SeedOutcomes& seed : outcomes) {
    seeds.push_back(
        {{"index", seed.seed_index}, {"outcomes", seed.outcomes}, {"unsafe", seed.unsafe}});
  }
  const Json json = {{"lease", lease}, {"task", options_.me.name()}, {"seeds", std::move(seeds)}};
  const std::string path = finished_path(folder_, lease);
  // Another task that drives the same lease writes the same content to a file of its own name.
  const std::string own = fmt::format("{}.{}", path, options_.me.name());
  write_file(own, json_text(json));
  commit_file(own, path);
  const std::lock_guard lock(mutex_);
  held_.erase(lease);
}

void LeaseQueue::write_held(std::int64_t lease, bool given_back) {
  overwrite_shared_file(claim_path(folder_, lease, held_.at(lease)),
                        claim_text(options_.me, beats_, given_back));
}

void LeaseQueue::give_back() {
  const std::lock_guard lock(mutex_);
  for (const auto& [lease, generation] : held_) write_held(lease, true);
  held_.clear();
}

void LeaseQueue::beat() {
  const std::lock_guard lock(mutex_);
  ++beats_;
  for (const auto& [lease, generation] : held_) write_held(lease, false);
}

}  // namespace qsmpc::harness
