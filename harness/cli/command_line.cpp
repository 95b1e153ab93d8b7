#include "harness/cli/command_line.hpp"

#include <vector>

#include <CLI/CLI.hpp>
#include <Eigen/Core>
#include <fmt/format.h>

#include "controller/planning/solvers/nlopt_version.hpp"
#include "harness/campaign/store/sqlite_version.hpp"
#include "harness/mujoco/newer_mjcf.hpp"
#include "harness/scenario/known_names.hpp"
#include "harness/text/printable.hpp"
#include "harness/trace/hdf5_version.hpp"
#include "harness/version.hpp"
#include "render/media/libav_version.hpp"

namespace qsmpc::harness {
namespace {

constexpr std::size_t kLongestWord = 100;     // bytes of what the user typed
constexpr std::size_t kLongestMessage = 400;  // bytes

/// The innermost command that was parsed, and the words that lead to it.
struct Parsed {
  const CLI::App* command;
  std::string parents{};  ///< "qsmpc campaign"; empty for the program itself
};

Parsed innermost(const CLI::App& app) {
  Parsed parsed{.command = &app};
  for (auto inner = app.get_subcommands(); !inner.empty();
       inner = parsed.command->get_subcommands()) {
    parsed.parents += (parsed.parents.empty() ? "" : " ") + parsed.command->get_name();
    parsed.command = inner.front();
  }
  return parsed;
}

std::string name_of(const Parsed& parsed) {
  return parsed.parents.empty() ? parsed.command->get_name()
                                : parsed.parents + " " + parsed.command->get_name();
}

std::vector<std::string> options_of(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::Option* option : command.get_options()) {
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  }
  return names;
}

std::vector<std::string> commands_of(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands({})) names.push_back(command->get_name());
  return names;
}

/// The unknown word in the command line; an option takes precedence.
std::string unknown_word(const CLI::App& app) {
  const std::vector<std::string> words = app.remaining(/*recurse=*/true);
  for (const std::string& word : words) {
    if (word.starts_with('-')) return word.substr(0, word.find('='));
  }
  return words.empty() ? "" : words.front();
}

std::string not_expected(const std::string& word, const std::string& expected) {
  return fmt::format("found {}, expected {}", printable(word, kLongestWord), expected);
}

}  // namespace

std::string help_of_parsed(const CLI::App& app) {
  const Parsed parsed = innermost(app);
  return parsed.command->help(parsed.parents);
}

std::string versions() {
  std::string text = fmt::format("qsmpc {}\n", kVersion);
  for (const auto& [library, version] :
       {std::pair("MuJoCo", mujoco_version()),
        std::pair("Eigen", fmt::format("{}.{}.{}", EIGEN_WORLD_VERSION, EIGEN_MAJOR_VERSION,
                                       EIGEN_MINOR_VERSION)),
        std::pair("NLopt", controller::nlopt_version()), std::pair("HDF5", hdf5_version()),
        std::pair("FFmpeg", render::libav_version()), std::pair("SQLite", sqlite_version())}) {
    text += fmt::format("{} {}\n", library, version);
  }
  return text;
}

std::string usage_problem(const CLI::App& app, const CLI::ParseError& error, int argc,
                          const char* const* argv) {
  const Parsed parsed = innermost(app);
  const std::string see = "; see " + name_of(parsed) + " --help";
  const std::string first = argc > 1 ? argv[1] : "";
  if (parsed.command == &app && !first.empty() && !first.starts_with('-')) {
    return not_expected(first, "a command: " + expected_names(first, commands_of(app))) + see;
  }
  const std::string word =
      dynamic_cast<const CLI::ExtrasError*>(&error) == nullptr ? "" : unknown_word(app);
  if (word.starts_with('-')) {
    return not_expected(word, expected_names(word, options_of(*parsed.command))) + see;
  }
  if (!word.empty()) return not_expected(word, "no more arguments") + see;
  return printable(error.what(), kLongestMessage) + see;
}

}  // namespace qsmpc::harness
