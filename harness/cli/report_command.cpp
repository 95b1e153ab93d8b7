#include <filesystem>
#include <memory>
#include <string>

#include <CLI/CLI.hpp>

#include "harness/atomic_file.hpp"
#include "harness/campaign/store/store_schema.hpp"
#include "harness/cli/artefacts.hpp"
#include "harness/cli/campaign_results.hpp"
#include "harness/cli/commands.hpp"
#include "harness/cli/exit_codes.hpp"
#include "harness/cli/output.hpp"
#include "harness/mismatch/comparison_file.hpp"
#include "harness/report/comparison_page.hpp"

namespace qsmpc {
namespace {

bool has(const std::string& folder, const char* file) {
  std::error_code ignored;
  return std::filesystem::exists(folder + "/" + file, ignored);
}

int report(const std::string& folder) {
  if (has(folder, kStoreFile)) {
    write_campaign_results(folder);
  } else if (has(folder, kComparisonFile)) {
    write_file(folder + "/" + kPageFile, comparison_page(read_comparison(folder)));
  } else {
    write_page(read_folder(folder), folder, has(folder, kVideoFile));
  }
  print_result(folder + "/" + kPageFile + "\n");
  return kDone;
}

}  // namespace

void add_report_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand("report",
                                         "Writes a self-contained HTML page from an episode's "
                                         "trace, a comparison's data or a campaign's\nstore, with "
                                         "its numbers, tables and figures.");
  command->footer("Example: qsmpc report out/dubins_obstacles-0");
  const auto folder = std::make_shared<std::string>();
  command->add_option("folder", *folder, "folder of an episode, a comparison or a campaign")
      ->required();
  command->callback([folder, &exit_code] { exit_code = report(*folder); });
}

}  // namespace qsmpc
