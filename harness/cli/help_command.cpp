#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "harness/cli/commands.hpp"
#include "harness/cli/exit_codes.hpp"
#include "harness/cli/output.hpp"
#include "harness/errors.hpp"
#include "harness/scenario/known_names.hpp"

namespace qsmpc::harness {
namespace {

/// The help of the command that `words` lead to.
std::string help_of(const CLI::App& app, const std::vector<std::string>& words) {
  const CLI::App* command = &app;
  std::string parents;
  for (const std::string& word : words) {
    const std::vector<const CLI::App*> inner = command->get_subcommands({});
    const auto found = std::ranges::find_if(
        inner, [&](const CLI::App* candidate) { return candidate->get_name() == word; });
    if (found == inner.end()) {
      std::vector<std::string> known;
      known.reserve(inner.size());
      for (const CLI::App* candidate : inner) known.push_back(candidate->get_name());
      throw InputError({.key = "help",
                        .found = word,
                        .expected = known.empty() ? "no command of " + command->get_name()
                                                  : expected_names(word, known)});
    }
    parents += (parents.empty() ? "" : " ") + command->get_name();
    command = *found;
  }
  // App::help would explain the command that was parsed, which is this one.
  const std::string name = (parents.empty() ? "" : parents + " ") + command->get_name();
  return command->get_formatter()->make_help(command, name, CLI::AppFormatMode::Normal);
}

}  // namespace

void add_help_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand("help", "Explains a command.");
  command->footer("Example: qsmpc help campaign status");
  const auto words = std::make_shared<std::vector<std::string>>();
  command->add_option("command", *words, "the command; default: the program");
  command->callback([&app, words, &exit_code] {
    print_result(help_of(app, *words));
    exit_code = kDone;
  });
}

}  // namespace qsmpc::harness
