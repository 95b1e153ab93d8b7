#include <memory>
#include <string>

#include <CLI/CLI.hpp>

#include "harness/campaign/status.hpp"
#include "harness/campaign/store/store_schema.hpp"
#include "harness/cli/commands.hpp"
#include "harness/cli/contest_files.hpp"
#include "harness/cli/exit_codes.hpp"
#include "harness/cli/output.hpp"
#include "harness/cluster/cluster_status.hpp"
#include "harness/cluster/lease_plan.hpp"
#include "harness/files/text_file.hpp"

namespace qsmpc::harness {
namespace {

bool has_store(const std::string& folder) { return is_file(folder + "/" + kStoreFile); }

/// A contest that is still searching for settings has only the store of the search.
std::string store_folder(const std::string& folder) {
  const std::string tuning = folder + "/" + kTuningFolder;
  return !has_store(folder) && has_store(tuning) ? tuning : folder;
}

}  // namespace

void add_campaign_status_command(CLI::App& campaign, int& exit_code) {
  CLI::App* command = campaign.add_subcommand(
      "status", "Shows the progress of a campaign, while it runs or afterwards; changes nothing.");
  command->footer("Example: qsmpc campaign status out/policies");
  const auto folder = std::make_shared<std::string>();
  const auto json = std::make_shared<bool>(false);
  command->add_option("folder", *folder, "folder of a campaign or contest")->required();
  command->add_flag("--json", *json, "print JSON");
  command->callback([folder, json, &exit_code] {
    if (has_lease_plan(*folder)) {
      const ClusterStatus status = cluster_status(*folder);
      print_result(*json ? cluster_status_json(status) : cluster_status_table(status));
      exit_code = kDone;
      return;
    }
    const CampaignStatus status = campaign_status(store_folder(*folder));
    print_result(*json ? status_json(status) : status_table(status));
    exit_code = kDone;
  });
}

}  // namespace qsmpc::harness
