#include "harness/cli/completion.hpp"

#include <string_view>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "harness/cli/command_tree.hpp"

namespace qsmpc::harness {
namespace {

/// The kind of a command's first positional argument.
enum class ArgumentKind {
  kNone,
  kScenario,
  kCampaign,
  kContest,
  kFolder,
  kFile,
  kChoice,
  kCommand
};

ArgumentKind kind_of(const CLI::Option& option) {
  if (!option_choices(option).empty()) return ArgumentKind::kChoice;
  const std::string name = option.get_name(true);
  if (name == "scenario") return ArgumentKind::kScenario;
  if (name == "campaign") return ArgumentKind::kCampaign;
  if (name == "contest") return ArgumentKind::kContest;
  if (name.starts_with("folder")) return ArgumentKind::kFolder;
  if (name == "command") return ArgumentKind::kCommand;
  return ArgumentKind::kFile;
}

const CLI::Option* first_positional(const CLI::App& command) {
  const std::vector<const CLI::Option*> all = positionals(command);
  return all.empty() ? nullptr : all.front();
}

std::vector<std::string> inner_names(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::App* inner : command.get_subcommands({})) names.push_back(inner->get_name());
  return names;
}

/// The words after "qsmpc" that lead to a command: "campaign status".
std::string words_of(const NamedCommand& command, const std::string& program) {
  const std::string name = command.name();
  return name.size() > program.size() ? name.substr(program.size() + 1) : "";
}

/// Shell cases of "COMMAND,WORD": the command that the word leads to.
std::string command_cases(const std::vector<NamedCommand>& commands, const std::string& program) {
  std::string text;
  for (const NamedCommand& command : commands) {
    if (command.parents.empty()) continue;
    const std::string words = words_of(command, program);
    const std::string name = command.command->get_name();
    const std::string parent =
        words.size() > name.size() ? words.substr(0, words.size() - name.size() - 1) : "";
    text += fmt::format("      '{},{}') at='{}' ;;\n", parent, name, words);
  }
  return text;
}

/// How bash completes the argument, including the subcommands that may stand in its place.
std::string bash_argument(const CLI::App& command, const CLI::App& app) {
  const CLI::Option* argument = first_positional(command);
  std::string words = fmt::format("{}", fmt::join(inner_names(command), " "));
  if (argument == nullptr) return fmt::format("_qsmpc_words '{}'", words);
  switch (kind_of(*argument)) {
    case ArgumentKind::kScenario:
      return fmt::format("_qsmpc_words \"{} $(_qsmpc_shipped scenarios)\" -f", words);
    case ArgumentKind::kCampaign:
      return fmt::format("_qsmpc_words \"{} $(_qsmpc_shipped campaigns)\" -f", words);
    case ArgumentKind::kContest:
      return fmt::format("_qsmpc_words \"{} $(_qsmpc_shipped contests)\" -f", words);
    case ArgumentKind::kFolder:
      return fmt::format("_qsmpc_words '{}' -d", words);
    case ArgumentKind::kChoice:
      return fmt::format("_qsmpc_words '{}'", fmt::join(option_choices(*argument), " "));
    case ArgumentKind::kCommand:
      return fmt::format("_qsmpc_words '{}'", fmt::join(inner_names(app), " "));
    default:
      return fmt::format("_qsmpc_words '{}' -f", words);
  }
}

/// The values of a command's options, as cases of "COMMAND:OPTION".
std::string bash_values(const std::string& words, const CLI::App& command) {
  std::string text;
  for (const CLI::Option* option : named_options(command)) {
    if (!takes_value(*option)) continue;
    std::string cases;
    for (const std::string& name : option_names(*option)) {
      cases += fmt::format("{}'{}:{}'", cases.empty() ? "" : "|", words, name);
    }
    const std::vector<std::string> choices = option_choices(*option);
    text += fmt::format("    {}) _qsmpc_words '{}'{}; return ;;\n", cases, fmt::join(choices, " "),
                        choices.empty() ? " -f" : "");
  }
  return text;
}

constexpr std::string_view kBashHead =
    R"(# Completion of qsmpc for bash, made by: qsmpc completion bash
_qsmpc_shipped() {
  qsmpc list "$1" 2>/dev/null | awk '/^  /{ print $1 }'
}

# _qsmpc_words 'WORDS' [-f|-d]: completes from WORDS, and from files or folders.
_qsmpc_words() {
  mapfile -t COMPREPLY < <(compgen -W "$1" -- "$cur"; [ -z "$2" ] || compgen "$2" -- "$cur")
}

_qsmpc() {
  local cur=${COMP_WORDS[COMP_CWORD]} previous=${COMP_WORDS[COMP_CWORD-1]} at='' i
  for ((i = 1; i < COMP_CWORD; i++)); do
    case "$at,${COMP_WORDS[i]}" in
)";

/// Text within single quotes and brackets of zsh's _arguments.
std::string zsh_text(std::string_view text) {
  std::string out;
  for (const char c : text) {
    if (c == '\n') break;
    if (c == '\'') {
      out += "'\\''";
    } else if (c == '[' || c == ']' || c == ':' || c == '\\') {
      out += {'\\', c};
    } else {
      out += c;
    }
  }
  return out;
}

std::string zsh_action(const CLI::Option& option) {
  const std::vector<std::string> choices = option_choices(option);
  if (!choices.empty()) return fmt::format("({})", fmt::join(choices, " "));
  if (option.nonpositional()) return "_files";
  switch (kind_of(option)) {
    case ArgumentKind::kScenario:
      return "{_qsmpc_shipped scenarios}";
    case ArgumentKind::kCampaign:
      return "{_qsmpc_shipped campaigns}";
    case ArgumentKind::kContest:
      return "{_qsmpc_shipped contests}";
    case ArgumentKind::kFolder:
      return "_files -/";
    default:
      return "_files";
  }
}

std::string zsh_arguments(const CLI::App& command) {
  std::string text;
  for (const CLI::Option* option : named_options(command)) {
    for (const std::string& name : option_names(*option)) {
      text += fmt::format(" \\\n        '*{}[{}]{}'", name, zsh_text(option->get_description()),
                          takes_value(*option) ? ":value:" + zsh_action(*option) : "");
    }
  }
  for (const CLI::Option* option : positionals(command)) {
    text += fmt::format(" \\\n        '*:{}:{}'", zsh_text(option->get_name(true)),
                        zsh_action(*option));
    break;
  }
  return text;
}

}  // namespace

std::string bash_completion(const CLI::App& app) {
  const std::vector<NamedCommand> commands = all_commands(app);
  std::string text(kBashHead);
  text += command_cases(commands, app.get_name());
  text += "    esac\n  done\n  case \"$at:$previous\" in\n";
  for (const NamedCommand& command : commands) {
    text += bash_values(words_of(command, app.get_name()), *command.command);
  }
  text += "  esac\n  case \"$at:$cur\" in\n";
  for (const NamedCommand& command : commands) {
    std::string options;
    for (const CLI::Option* option : named_options(*command.command)) {
      options +=
          fmt::format("{}{}", options.empty() ? "" : " ", fmt::join(option_names(*option), " "));
    }
    const std::string words = words_of(command, app.get_name());
    text += fmt::format("    '{}:-'*) _qsmpc_words '{}' ;;\n", words, options);
    text += fmt::format("    '{}:'*) {} ;;\n", words, bash_argument(*command.command, app));
  }
  return text + "  esac\n}\ncomplete -o filenames -F _qsmpc qsmpc\n";
}

std::string zsh_completion(const CLI::App& app) {
  std::string text =
      "#compdef qsmpc\n# Completion of qsmpc for zsh, made by: qsmpc completion zsh\n"
      "_qsmpc_shipped() {\n  local -a names\n"
      "  names=(${(f)\"$(qsmpc list $1 2>/dev/null | awk '/^  /{ print $1 }')\"})\n"
      "  compadd -a names\n  _files\n}\n\n_qsmpc() {\n  local at='' word\n"
      "  for word in ${words[2,CURRENT-1]}; do\n    case \"$at,$word\" in\n";
  const std::vector<NamedCommand> commands = all_commands(app);
  text += command_cases(commands, app.get_name());
  text += "    esac\n  done\n  case $at in\n";
  for (const NamedCommand& command : commands) {
    text += fmt::format("    '{}')\n", words_of(command, app.get_name()));
    const std::vector<const CLI::App*> inner = command.command->get_subcommands({});
    if (!inner.empty()) {
      text += "      local -a commands\n      commands=(\n";
      for (const CLI::App* one : inner) {
        text += fmt::format("        '{}:{}'\n", one->get_name(), zsh_text(one->get_description()));
      }
      text += "      )\n      [[ $PREFIX == -* ]] || _describe command commands\n";
    }
    text += "      _arguments" + zsh_arguments(*command.command) + "\n      ;;\n";
  }
  return text + "  esac\n}\n\n_qsmpc \"$@\"\n";
}

}  // namespace qsmpc::harness
