#include "harness/cli/program.hpp"

#include <exception>
#include <iostream>
#include <string>

#include <CLI/CLI.hpp>

#include "harness/cli/commands.hpp"
#include "harness/cli/exit_codes.hpp"
#include "harness/cli/interrupt.hpp"
#include "harness/cli/output.hpp"
#include "harness/text/printable.hpp"
#include "harness/version.hpp"

namespace qsmpc::harness {
namespace {

int parse_and_run(int argc, char** argv) {
  CLI::App app("qsmpc: stochastic model predictive control by quantisation, on MuJoCo plants");
  app.set_version_flag("--version", std::string("qsmpc ") + kVersion);
  app.require_subcommand(1);
  app.footer(
      "Example: qsmpc run dubins_obstacles --seed 1 --out out/first\n"
      "Each command has --help. Exit codes: 0 done, 1 an outcome of --fail-on, 2 bad usage "
      "or file,\n3 input/output trouble, 4 internal error, 130 interrupted.");
  int exit_code = kDone;
  add_run_command(app, exit_code);
  add_predict_command(app, exit_code);
  add_compare_command(app, exit_code);
  add_campaign_command(app, exit_code);
  add_render_command(app, exit_code);
  add_report_command(app, exit_code);
  add_reproduce_command(app, exit_code);
  add_doctor_command(app, exit_code);
  add_list_command(app, exit_code);
  add_schema_command(app, exit_code);
  add_validate_command(app, exit_code);
  try {
    app.parse(argc, argv);
  } catch (const CLI::CallForHelp&) {
    const auto chosen = app.get_subcommands();
    print_result((chosen.empty() ? app : *chosen.front()).help());
  } catch (const CLI::CallForVersion&) {
    print_result(app.version() + "\n");
  } catch (const CLI::ParseError& error) {
    std::cerr << "qsmpc: " << printable(error.what(), 400) << "; see qsmpc --help\n";
    return kBadInput;
  }
  return exit_code;
}

}  // namespace

int run_program(int argc, char** argv) {
  try {
    catch_interrupts();
    return parse_and_run(argc, argv);
  } catch (...) {
    return report_exception(std::current_exception());
  }
}

}  // namespace qsmpc::harness
