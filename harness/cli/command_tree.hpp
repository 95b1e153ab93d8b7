// The parser's commands, from which help, manual pages and completion are made.
#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace qsmpc::harness {

struct NamedCommand {
  const CLI::App* command = nullptr;
  std::string parents{};  ///< the words that lead to it, "qsmpc campaign"; empty for the program

  /// "qsmpc campaign status", or with another separator.
  [[nodiscard]] std::string name(const char* separator = " ") const;
};

/// The command that `words` lead to from `app`. Throws InputError, naming the nearest command, if
/// there is none.
[[nodiscard]] NamedCommand command_called(const CLI::App& app,
                                          const std::vector<std::string>& words);

/// `app` and all commands below it, each before its subcommands.
[[nodiscard]] std::vector<NamedCommand> all_commands(const CLI::App& app);

/// What may be typed after a command: its options with names, and its positional arguments.
[[nodiscard]] std::vector<const CLI::Option*> named_options(const CLI::App& command);
[[nodiscard]] std::vector<const CLI::Option*> positionals(const CLI::App& command);

/// "--json", "-h": all names of an option.
[[nodiscard]] std::vector<std::string> option_names(const CLI::Option& option);

/// Whether a value follows the option's name.
[[nodiscard]] bool takes_value(const CLI::Option& option);

/// The allowed values of the option; empty if any value is allowed.
[[nodiscard]] std::vector<std::string> option_choices(const CLI::Option& option);

}  // namespace qsmpc::harness
