#include "harness/cli/campaign_driving.hpp"

#include <iostream>

#include <fmt/format.h>

#include "harness/assembly/memory_need.hpp"
#include "harness/campaign/status.hpp"
#include "harness/cli/interrupt.hpp"
#include "harness/cli/progress.hpp"
#include "harness/errors.hpp"

namespace qsmpc::harness {
namespace {

void tell_update(const StoreUpdate& update) {
  std::cerr << fmt::format(
      "qsmpc: the campaign has changed: {} episodes are kept, {} are no longer asked for and were "
      "removed\n",
      update.kept, update.dropped);
}

}  // namespace

void refuse_beyond_memory(const Campaign& campaign, const std::string& file, int jobs) {
  const double usable = usable_memory();
  for (const CampaignVariant& variant : campaign.variants) {
    const auto problem = memory_problem(variant.resolved, jobs, usable);
    if (!problem) continue;
    throw InputError({.file = file,
                      .key = "variant " + variant.name,
                      .found = problem->found,
                      .expected = problem->expected + ", e.g. with fewer --jobs"});
  }
}

CampaignProgress drive_campaign(const Campaign& campaign, const std::string& folder,
                                CampaignOptions options, const CampaignTalk& talk) {
  Progress progress(talk.label, talk.quiet);
  options.should_stop = [] { return interrupts() > 0; };
  options.should_hurry = [] { return interrupts() > 1; };
  if (!talk.quiet) options.on_update = tell_update;
  options.on_progress = [&](const CampaignProgress& now) {
    progress.update(now.done, now.total, progress_note(now));
  };
  const InterruptPatience patience(2);  // the first interrupt lets episodes finish
  return run_campaign(campaign, folder, options);
}

}  // namespace qsmpc::harness
