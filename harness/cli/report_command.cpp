#include <filesystem>
#include <memory>
#include <string>

#include <CLI/CLI.hpp>

#include "harness/campaign/store/store_schema.hpp"
#include "harness/cli/artefacts.hpp"
#include "harness/cli/campaign_results.hpp"
#include "harness/cli/commands.hpp"
#include "harness/cli/exit_codes.hpp"
#include "harness/cli/output.hpp"

namespace qsmpc {
namespace {

int report(const std::string& folder) {
  std::error_code ignored;
  if (std::filesystem::exists(folder + "/" + kStoreFile, ignored)) {
    write_campaign_results(folder);
    print_result(folder + "/" + kPageFile + "\n");
    return kDone;
  }
  const Trace trace = read_folder(folder);
  write_page(trace, folder, std::filesystem::exists(folder + "/" + kVideoFile, ignored));
  print_result(folder + "/" + kPageFile + "\n");
  return kDone;
}

}  // namespace

void add_report_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand("report",
                                         "Writes a self-contained HTML page from an episode's "
                                         "trace, or of a campaign's store, with its\n"
                                         "numbers, tables and figures.");
  command->footer("Example: qsmpc report out/dubins_obstacles-0");
  const auto folder = std::make_shared<std::string>();
  command->add_option("folder", *folder, "folder of an episode or a campaign")->required();
  command->callback([folder, &exit_code] { exit_code = report(*folder); });
}

}  // namespace qsmpc
