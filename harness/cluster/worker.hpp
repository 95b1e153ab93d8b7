// A task: one of the processes, on any machine, that drive a campaign together through its folder.
//
// Its store is in a folder created by this start of the task, to which no other process writes.
// Nothing that it writes is ever written by another process, so a network file system needs neither
// file locks nor memory shared coherently across machines.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "harness/campaign/campaign.hpp"
#include "harness/cluster/lease_plan.hpp"

namespace qsmpc::harness {

struct WorkerOptions {
  int task = 1;  ///< its number, ≥ 1; tasks with the same number still have separate stores
  int jobs = 1;  ///< ≥ 1, concurrent episodes
  /// As in CampaignOptions.
  std::function<bool()> should_stop{};
  std::function<bool()> should_hurry{};
};

struct WorkerEnd {
  bool all_finished = false;  ///< all leases of the campaign are finished; else it was told to stop
  std::int64_t episodes = 0;  ///< episodes that it drove
  double seconds = 0.0;
};

/// Drives leases of `campaign`, the `planned_campaign` of the plan in `folder`, until all are
/// finished or it is asked to stop; leases that it has begun but not finished are given back.
///
/// Throws IoError if the folder or its own store cannot be written, e.g. because the disk is full.
/// What it has finished is kept; the leases that it has begun are driven again by other tasks.
[[nodiscard]] WorkerEnd run_worker(const LeasePlan& plan, const Campaign& campaign,
                                   const std::string& folder, const WorkerOptions& options);

}  // namespace qsmpc::harness
