#include "harness/cli/command_tree.hpp"

#include <algorithm>
#include <sstream>

#include <CLI/CLI.hpp>

#include "harness/errors.hpp"
#include "harness/scenario/known_names.hpp"

namespace qsmpc::harness {

std::string NamedCommand::name(const char* separator) const {
  std::string whole = parents.empty() ? command->get_name() : parents + " " + command->get_name();
  for (std::size_t at = whole.find(' '); at != std::string::npos; at = whole.find(' ', at + 1)) {
    whole.replace(at, 1, separator);
  }
  return whole;
}

NamedCommand command_called(const CLI::App& app, const std::vector<std::string>& words) {
  NamedCommand found{.command = &app};
  for (const std::string& word : words) {
    const std::vector<const CLI::App*> inner = found.command->get_subcommands({});
    const auto next = std::ranges::find_if(
        inner, [&](const CLI::App* candidate) { return candidate->get_name() == word; });
    if (next == inner.end()) {
      std::vector<std::string> known;
      known.reserve(inner.size());
      for (const CLI::App* candidate : inner) known.push_back(candidate->get_name());
      throw InputError({.key = "command",
                        .found = word,
                        .expected = known.empty() ? "no command of " + found.command->get_name()
                                                  : expected_names(word, known)});
    }
    found = {.command = *next, .parents = found.name()};
  }
  return found;
}

std::vector<NamedCommand> all_commands(const CLI::App& app) {
  std::vector<NamedCommand> all{{.command = &app}};
  for (std::size_t i = 0; i < all.size(); ++i) {
    const NamedCommand at = all[i];
    std::vector<NamedCommand> below;
    for (const CLI::App* inner : at.command->get_subcommands({})) {
      below.push_back({.command = inner, .parents = at.name()});
    }
    all.insert(all.begin() + static_cast<std::ptrdiff_t>(i) + 1, below.begin(), below.end());
  }
  return all;
}

std::vector<const CLI::Option*> named_options(const CLI::App& command) {
  return command.get_options([](const CLI::Option* option) { return option->nonpositional(); });
}

std::vector<const CLI::Option*> positionals(const CLI::App& command) {
  return command.get_options([](const CLI::Option* option) { return option->get_positional(); });
}

std::vector<std::string> option_names(const CLI::Option& option) {
  std::vector<std::string> names;
  for (const std::string& name : option.get_snames()) names.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) names.push_back("--" + name);
  for (const std::string& name : option.get_fnames()) {
    const std::string negative = "--" + name;
    if (std::ranges::find(names, negative) == names.end()) names.push_back(negative);
  }
  return names;
}

bool takes_value(const CLI::Option& option) { return option.get_expected_max() > 0; }

std::vector<std::string> option_choices(const CLI::Option& option) {
  // A set of names follows the type's name: "TEXT:{lbfgs,slsqp}".
  const std::string type = option.get_type_name();
  const std::size_t begin = type.find('{');
  const std::size_t end = type.find('}', begin);
  if (begin == std::string::npos || end == std::string::npos) return {};
  std::vector<std::string> choices;
  std::istringstream words(type.substr(begin + 1, end - begin - 1));
  for (std::string word; std::getline(words, word, ',');) choices.push_back(word);
  return choices;
}

}  // namespace qsmpc::harness
