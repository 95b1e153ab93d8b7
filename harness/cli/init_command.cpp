#include <filesystem>
#include <memory>
#include <string>
#include <system_error>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "harness/cli/commands.hpp"
#include "harness/cli/exit_codes.hpp"
#include "harness/cli/output.hpp"
#include "harness/errors.hpp"
#include "harness/files/atomic_file.hpp"
#include "harness/scenario/new_scenario.hpp"
#include "harness/scenario/scenario_file.hpp"

namespace qsmpc::harness {
namespace {

namespace fs = std::filesystem;

constexpr const char* kInitHelp =
    "Writes a commented scenario, ready to run, as a starting point: NAME.yaml in the current\n"
    "folder, or the path NAME. Never replaces an existing file.";

int init(const std::string& name) {
  const bool is_file = name.ends_with(".yaml") || name.ends_with(".yml");
  const std::string path = is_file ? name : name + ".yaml";
  const std::string text = new_scenario_text(fs::path(path).stem().string());
  (void)parse_scenario(text, {.file = path});  // throws if the name is invalid
  std::error_code error;
  if (fs::symlink_status(path, error).type() != fs::file_type::not_found) {
    throw InputError({.file = path, .found = "an existing file", .expected = "an unused name"});
  }
  write_file(path, text);
  print_result(fmt::format("{0}\n  check  qsmpc validate {0}\n  drive  qsmpc run {0}\n", path));
  return kDone;
}

}  // namespace

void add_init_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand("init", kInitHelp);
  command->footer("Example: qsmpc init my_car && qsmpc run my_car.yaml");
  const auto name = std::make_shared<std::string>("my_scenario");
  command->add_option("name", *name, "name of the scenario, or its file; default: my_scenario");
  command->callback([name, &exit_code] { exit_code = init(*name); });
}

}  // namespace qsmpc::harness
