// A task: one process of the many, on any machine, that drive a campaign through its folder.
//
// Its store is in a folder that this start of the task made for itself and nobody else writes to.
// Nothing that it writes is ever written by another, so that a network's file system need neither
// lock files nor keep memory of several machines the same.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "harness/campaign/campaign.hpp"
#include "harness/cluster/lease_plan.hpp"

namespace qsmpc::harness {

struct WorkerOptions {
  int task = 1;  ///< its number, ≥ 1; of several that share one, each has a store of its own
  int jobs = 1;  ///< ≥ 1, episodes at the same time
  /// As in CampaignOptions.
  std::function<bool()> should_stop{};
  std::function<bool()> should_hurry{};
};

struct WorkerEnd {
  bool all_finished = false;  ///< all leases of the campaign are; else it was asked to stop
  std::int64_t episodes = 0;  ///< that it drove
  double seconds = 0.0;
};

/// Drives leases of `campaign`, which is `planned_campaign` of the plan of `folder`, until all are
/// finished or it is asked to stop; leases that it began and did not finish are given back.
///
/// Throws IoError where the folder or its own store cannot be written, e.g. on a full disk. What it
/// has finished stays; the leases that it has begun are driven again by others.
[[nodiscard]] WorkerEnd run_worker(const LeasePlan& plan, const Campaign& campaign,
                                   const std::string& folder, const WorkerOptions& options);

}  // namespace qsmpc::harness
