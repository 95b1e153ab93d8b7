#include <memory>
#include <string>

#include <CLI/CLI.hpp>

#include "harness/campaign/status.hpp"
#include "harness/cli/commands.hpp"
#include "harness/cli/exit_codes.hpp"
#include "harness/cli/output.hpp"

namespace qsmpc::harness {

void add_campaign_status_command(CLI::App& campaign, int& exit_code) {
  CLI::App* command = campaign.add_subcommand(
      "status", "Tells how far a campaign is, while it runs or after; changes nothing.");
  command->footer("Example: qsmpc campaign status out/policies");
  const auto folder = std::make_shared<std::string>();
  const auto json = std::make_shared<bool>(false);
  command->add_option("folder", *folder, "folder of a campaign")->required();
  command->add_flag("--json", *json, "as JSON");
  command->callback([folder, json, &exit_code] {
    const CampaignStatus status = campaign_status(*folder);
    print_result(*json ? status_json(status) : status_table(status));
    exit_code = kDone;
  });
}

}  // namespace qsmpc::harness
