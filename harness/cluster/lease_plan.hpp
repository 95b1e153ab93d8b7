// The plan of a campaign that is driven by tasks on machines which share its folder: what is
// driven, and how its seeds are cut into leases. It is written once and never changes, and holds
// all that a task needs, so that the campaign's file may be edited meanwhile.
//
// In the campaign's folder, everything of the tasks is below `cluster`:
//
//   plan.json        this plan
//   launch.json      how tasks were started last
//   claims/L.G       who drives lease L; G counts those who took it over
//   finished/L.json  how the episodes of lease L ended; its rows are on the disk
//   tasks/T-A        the store and the kept traces of task T at its A-th start
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "harness/campaign/campaign.hpp"
#include "harness/campaign/store/store.hpp"

namespace qsmpc::harness {

/// The folder of the tasks within a campaign's, and what is in it.
inline constexpr const char* kClusterFolder = "cluster";
inline constexpr const char* kPlanFile = "plan.json";
inline constexpr const char* kClaimsFolder = "claims";
inline constexpr const char* kFinishedFolder = "finished";
inline constexpr const char* kTasksFolder = "tasks";

/// The most leases that a plan has: as many files as a folder holds with ease.
inline constexpr std::int64_t kMostLeases = 100'000;

/// FOLDER/cluster/NAME.
[[nodiscard]] std::string cluster_path(const std::string& folder, const std::string& name);

struct LeasePlan {
  CampaignIdentity identity;  ///< with all of the campaign's seeds: shard 1/1
  /// CampaignVariant::overrides of each variant; they change nothing that the identity does not
  /// say.
  std::vector<std::vector<std::string>> overrides{};
  TraceKeeping traces = TraceKeeping::kNone;
  std::int64_t trace_sample = 0;
  SeedSet seeds{};
  std::int64_t lease_seeds = 1;  ///< seeds of a lease, ≥ 1; the last one may have fewer

  [[nodiscard]] std::int64_t leases() const { return leases_of(seeds.size()); }
  [[nodiscard]] std::int64_t first_seed_of(std::int64_t lease) const { return lease * lease_seeds; }
  [[nodiscard]] std::int64_t seeds_of(std::int64_t lease) const {
    return std::min(lease_seeds, seeds.size() - first_seed_of(lease));
  }
  /// Leases that the first `count` seeds are in.
  [[nodiscard]] std::int64_t leases_of(std::int64_t count) const {
    return (count + lease_seeds - 1) / lease_seeds;
  }
  /// At most, where the campaign has a rule that stops it.
  [[nodiscard]] std::int64_t episodes() const { return identity.campaign.episodes; }
};

/// Seeds of a lease where nobody says how many: some sixteen leases for each episode that is driven
/// at the same time, so that slow machines hold nobody up at the end, and few where there are many.
[[nodiscard]] std::int64_t default_lease_seeds(std::int64_t seeds, std::int64_t at_once);

/// Throws InputError where a vehicle cannot be loaded, or where there would be too many leases.
[[nodiscard]] LeasePlan lease_plan(const Campaign& campaign, std::int64_t lease_seeds);

/// The campaign as it was when the plan was made. Throws InputError where this program is of
/// another version than the plan, or where a vehicle is no longer what it was or not there.
[[nodiscard]] Campaign planned_campaign(const LeasePlan& plan, const std::string& folder);

/// The same without the variants' scenarios, for those who do not drive.
[[nodiscard]] Campaign campaign_outline(const LeasePlan& plan);

/// Writes the plan and makes the folders of the tasks. Throws IoError.
void write_lease_plan(const LeasePlan& plan, const std::string& folder);

/// Whether the campaign in `folder` has a plan.
[[nodiscard]] bool has_lease_plan(const std::string& folder);

/// Throws InputError where there is none, or one that this program cannot read; IoError.
[[nodiscard]] LeasePlan read_lease_plan(const std::string& folder);

}  // namespace qsmpc::harness
