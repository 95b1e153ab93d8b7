#include "harness/cli/manual.hpp"

#include <algorithm>
#include <cctype>
#include <string_view>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "harness/files/atomic_file.hpp"
#include "harness/version.hpp"

namespace qsmpc::harness {
namespace {

/// Escapes text for roff: no character acts as a request, and hyphens are ASCII ones.
std::string roff(std::string_view text) {
  std::string out;
  bool at_start = true;
  for (const char c : text) {
    if (at_start && (c == '.' || c == '\'')) out += "\\&";
    if (c == '-') {
      out += "\\-";
    } else if (c == '\\') {
      out += "\\e";
    } else {
      out += c;
    }
    at_start = c == '\n';
  }
  return out;
}

std::string upper(std::string text) {
  std::ranges::transform(text, text.begin(),
                         [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  return text;
}

/// The beginning of a command's description, on one line.
std::string summary_of(const CLI::App& command) {
  std::string text = command.get_description();
  std::ranges::replace(text, '\n', ' ');
  const std::size_t last = text.find_last_not_of(". ") + 1;
  return text.substr(0, std::min({text.find(". "), text.find("; "), text.find(": "), last}));
}

std::string argument_of(const CLI::Option& option) {
  const std::vector<std::string> choices = option_choices(option);
  if (!choices.empty()) return fmt::format("{}", fmt::join(choices, "|"));
  const std::string type = option.get_type_name();
  return type.substr(0, type.find(':'));
}

std::string positional_name(const CLI::Option& option) {
  const std::string name = upper(option.get_name(true));
  const std::string repeated = option.get_expected_max() > 1 ? name + " ..." : name;
  return option.get_required() ? repeated : "[" + repeated + "]";
}

std::string option_entry(const CLI::Option& option) {
  std::vector<std::string> names;
  for (const std::string& name : option_names(option))
    names.push_back("\\fB" + roff(name) + "\\fR");
  std::string text = fmt::format(".TP\n{}", fmt::join(names, ", "));
  if (takes_value(option)) text += " \\fI" + roff(argument_of(option)) + "\\fR";
  return text + "\n" + roff(option.get_description()) + "\n";
}

std::string synopsis(const NamedCommand& command) {
  std::string text = ".SH SYNOPSIS\n.B " + roff(command.name()) + "\n";
  if (!named_options(*command.command).empty()) text += "[\\fIOPTIONS\\fR]\n";
  for (const CLI::Option* option : positionals(*command.command)) {
    text += "\\fI" + roff(positional_name(*option)) + "\\fR\n";
  }
  if (!command.command->get_subcommands({}).empty()) {
    text += command.command->get_require_subcommand_min() > 0 ? "\\fICOMMAND\\fR ...\n"
                                                              : "[\\fICOMMAND\\fR ...]\n";
  }
  return text;
}

std::string sections_of_arguments(const CLI::App& command) {
  std::string text;
  const std::vector<const CLI::Option*> places = positionals(command);
  if (!places.empty()) text += ".SH ARGUMENTS\n";
  for (const CLI::Option* option : places) {
    text += ".TP\n\\fI" + roff(upper(option->get_name(true))) + "\\fR\n" +
            roff(option->get_description()) + "\n";
  }
  text += ".SH OPTIONS\n";
  for (const CLI::Option* option : named_options(command)) text += option_entry(*option);
  return text;
}

/// Related pages: those of its subcommands, and that of its parent.
std::string related(const NamedCommand& command) {
  std::vector<std::string> pages;
  if (!command.parents.empty()) {
    std::string parent = command.parents;
    std::ranges::replace(parent, ' ', '-');
    pages.push_back(parent);
  }
  for (const CLI::App* inner : command.command->get_subcommands({})) {
    pages.push_back(manual_name({.command = inner, .parents = command.name()}));
  }
  std::string text = ".SH SEE ALSO\n";
  for (std::size_t i = 0; i < pages.size(); ++i) {
    text += ".BR " + roff(pages[i]) + (i + 1 < pages.size() ? " (1),\n" : " (1)\n");
  }
  return text;
}

constexpr const char* kExitStatus =
    ".SH EXIT STATUS\n"
    ".TP\n.B 0\ndone\n"
    ".TP\n.B 1\nran, and the outcome is one of \\-\\-fail\\-on\n"
    ".TP\n.B 2\nbad usage, or a bad file\n"
    ".TP\n.B 3\ninput/output error\n"
    ".TP\n.B 4\ninternal error\n"
    ".TP\n.B 130\ninterrupted; what was finished is kept\n";

}  // namespace

std::string manual_name(const NamedCommand& command) { return command.name("-"); }

std::string manual_page(const NamedCommand& command) {
  const std::string name = manual_name(command);
  std::string text =
      fmt::format(".TH {} 1 \"\" \"qsmpc {}\" \"User Commands\"\n", roff(upper(name)), kVersion);
  text += ".SH NAME\n" + roff(name) + " \\- " + roff(summary_of(*command.command)) + "\n";
  text += synopsis(command);
  text += ".SH DESCRIPTION\n" + roff(command.command->get_description()) + "\n";
  text += sections_of_arguments(*command.command);
  const std::vector<const CLI::App*> inner = command.command->get_subcommands({});
  if (!inner.empty()) text += ".SH COMMANDS\n";
  for (const CLI::App* one : inner) {
    text += ".TP\n.B " + roff(one->get_name()) + "\n" + roff(summary_of(*one)) + "\n";
  }
  const std::string footer = command.command->get_footer();
  if (!footer.empty()) text += ".SH EXAMPLES\n.nf\n" + roff(footer) + "\n.fi\n";
  return text + kExitStatus + related(command);
}

void write_manual(const CLI::App& app, const std::string& folder) {
  for (const NamedCommand& command : all_commands(app)) {
    write_file(folder + "/" + manual_name(command) + ".1", manual_page(command));
  }
}

}  // namespace qsmpc::harness
