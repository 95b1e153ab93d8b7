#include <filesystem>
#include <memory>
#include <string>
#include <system_error>
#include <vector>

#include <CLI/CLI.hpp>

#include "harness/campaign/store/merge.hpp"
#include "harness/cli/campaign_results.hpp"
#include "harness/cli/commands.hpp"
#include "harness/cli/exit_codes.hpp"
#include "harness/files/atomic_file.hpp"
#include "harness/files/text_file.hpp"

namespace qsmpc::harness {
namespace {

struct MergeArguments {
  std::vector<std::string> folders;
  std::string out;
  bool json = false;
};

int merge(const MergeArguments& arguments) {
  merge_shards(arguments.folders, arguments.out);
  const std::string campaign = arguments.folders.front() + "/" + kCampaignCopy;
  std::error_code ignored;
  if (std::filesystem::exists(campaign, ignored)) {
    write_file(arguments.out + "/" + kCampaignCopy, read_text_file(campaign));
  }
  const CampaignStatistics statistics =
      write_campaign_results(arguments.out, kWorstListed, /*is_verified=*/true);
  print_campaign_results(statistics, arguments.out, arguments.json);
  return kDone;
}

}  // namespace

void add_campaign_merge_command(CLI::App& campaign, int& exit_code) {
  CLI::App* command = campaign.add_subcommand("merge",
                                              "Joins the finished shards of a campaign and checks "
                                              "that no episode is missing or duplicated.");
  command->footer("Example: qsmpc campaign merge out/one out/two --out out/policies");
  const auto arguments = std::make_shared<MergeArguments>();
  command->add_option("folders", arguments->folders, "folders of all shards")->required();
  command->add_option("--out", arguments->out, "output folder, which must not hold a campaign yet")
      ->required();
  command->add_flag("--json", arguments->json, "print campaign.json instead of the table");
  command->callback([arguments, &exit_code] { exit_code = merge(*arguments); });
}

}  // namespace qsmpc::harness
