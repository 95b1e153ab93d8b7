#include <memory>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "harness/cli/command_tree.hpp"
#include "harness/cli/commands.hpp"
#include "harness/cli/exit_codes.hpp"
#include "harness/cli/manual.hpp"
#include "harness/cli/output.hpp"

namespace qsmpc::harness {
namespace {

/// The help of the command that `words` lead to.
std::string help_of(const CLI::App& app, const std::vector<std::string>& words) {
  const NamedCommand called = command_called(app, words);
  // App::help would explain the parsed command, which is this one.
  return called.command->get_formatter()->make_help(called.command, called.name(),
                                                    CLI::AppFormatMode::Normal);
}

}  // namespace

void add_help_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand("help", "Explains a command.");
  command->footer("Example: qsmpc help campaign status");
  const auto words = std::make_shared<std::vector<std::string>>();
  const auto folder = std::make_shared<std::string>();
  command->add_option("command", *words, "the command; default: the program");
  command->add_option("--write-manual", *folder,
                      "FOLDER: write the manual pages of all commands into it instead");
  command->callback([&app, words, folder, &exit_code] {
    if (folder->empty()) {
      print_result(help_of(app, *words));
    } else {
      write_manual(app, *folder);
    }
    exit_code = kDone;
  });
}

}  // namespace qsmpc::harness
