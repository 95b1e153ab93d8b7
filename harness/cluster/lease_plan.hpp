// The plan of a campaign driven by tasks on machines that share its folder: what is driven, and how
// its seeds are divided into leases. It is written once, never changes, and contains all that a
// task needs, so that the campaign's file may be edited meanwhile.
//
// In the campaign's folder, all files of the tasks are below `cluster`:
//
//   plan.json        this plan
//   launch.json      the last launch of the tasks
//   claims/L.G       the task that drives lease L; G counts takeovers
//   finished/L.json  how the episodes of lease L ended; its rows are on disk
//   tasks/T-A        the store and the kept traces of task T at its A-th start
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "harness/campaign/campaign.hpp"
#include "harness/campaign/store/store.hpp"

namespace qsmpc::harness {

/// The tasks' folder in a campaign's folder, and its contents.
inline constexpr const char* kClusterFolder = "cluster";
inline constexpr const char* kPlanFile = "plan.json";
inline constexpr const char* kClaimsFolder = "claims";
inline constexpr const char* kFinishedFolder = "finished";
inline constexpr const char* kTasksFolder = "tasks";

/// The maximum number of leases of a plan: as many files as a folder can easily hold.
inline constexpr std::int64_t kMostLeases = 100'000;

/// FOLDER/cluster/NAME.
[[nodiscard]] std::string cluster_path(const std::string& folder, const std::string& name);

struct LeasePlan {
  CampaignIdentity identity;  ///< for all of the campaign's seeds: shard 1/1
  /// CampaignVariant::overrides of each variant; their effects are already part of the identity.
  std::vector<std::vector<std::string>> overrides{};
  TraceKeeping traces = TraceKeeping::kNone;
  std::int64_t trace_sample = 0;
  SeedSet seeds{};
  std::int64_t lease_seeds = 1;  ///< seeds per lease, ≥ 1; the last lease may have fewer

  [[nodiscard]] std::int64_t leases() const { return leases_of(seeds.size()); }
  [[nodiscard]] std::int64_t first_seed_of(std::int64_t lease) const { return lease * lease_seeds; }
  [[nodiscard]] std::int64_t seeds_of(std::int64_t lease) const {
    return std::min(lease_seeds, seeds.size() - first_seed_of(lease));
  }
  /// The number of leases that contain the first `count` seeds.
  [[nodiscard]] std::int64_t leases_of(std::int64_t count) const {
    return (count + lease_seeds - 1) / lease_seeds;
  }
  /// The number of episodes; a maximum if the campaign has a stop rule.
  [[nodiscard]] std::int64_t episodes() const { return identity.campaign.episodes; }
};

/// Default number of seeds per lease: about sixteen leases per concurrent episode, so that slow
/// machines do not delay the end, with 1 to 64 seeds each, but at most kMostLeases / 10 leases in
/// all.
[[nodiscard]] std::int64_t default_lease_seeds(std::int64_t seeds, std::int64_t at_once);

/// Throws InputError if a vehicle cannot be loaded, or if there would be too many leases.
[[nodiscard]] LeasePlan lease_plan(const Campaign& campaign, std::int64_t lease_seeds);

/// The campaign as it was when the plan was made. Throws InputError if this program's version
/// differs from the plan's, or if a vehicle has changed or is missing.
[[nodiscard]] Campaign planned_campaign(const LeasePlan& plan, const std::string& folder);

/// The same without the variants' scenarios, for callers that do not drive.
[[nodiscard]] Campaign campaign_outline(const LeasePlan& plan);

/// Writes the plan and creates the tasks' folders. Throws IoError.
void write_lease_plan(const LeasePlan& plan, const std::string& folder);

/// Whether the campaign in `folder` has a plan.
[[nodiscard]] bool has_lease_plan(const std::string& folder);

/// Reads the plan. Throws InputError if there is none, or one that this program cannot read;
/// IoError.
[[nodiscard]] LeasePlan read_lease_plan(const std::string& folder);

}  // namespace qsmpc::harness
