#include "harness/cli/program.hpp"

#include <exception>
#include <iostream>

#include <CLI/CLI.hpp>

#include "harness/cli/command_line.hpp"
#include "harness/cli/commands.hpp"
#include "harness/cli/exit_codes.hpp"
#include "harness/cli/interrupt.hpp"
#include "harness/cli/output.hpp"

namespace qsmpc::harness {
namespace {

int parse_and_run(int argc, char** argv) {
  CLI::App app("qsmpc: stochastic model predictive control by quantisation, on MuJoCo plants",
               "qsmpc");
  app.set_version_flag("--version", versions,
                       "Print the versions of the program and its libraries");
  app.require_subcommand(1);
  app.footer(
      "Example: qsmpc run dubins_obstacles --seed 1 --out out/first\n"
      "Each command has --help. Exit codes: 0 done, 1 an outcome of --fail-on, 2 bad usage "
      "or file,\n3 input/output error, 4 internal error, 130 interrupted.");
  int exit_code = kDone;
  add_init_command(app, exit_code);
  add_run_command(app, exit_code);
  add_predict_command(app, exit_code);
  add_compare_command(app, exit_code);
  add_campaign_command(app, exit_code);
  add_contest_command(app, exit_code);
  add_render_command(app, exit_code);
  add_report_command(app, exit_code);
  add_export_command(app, exit_code);
  add_reproduce_command(app, exit_code);
  add_doctor_command(app, exit_code);
  add_fit_command(app, exit_code);
  add_list_command(app, exit_code);
  add_schema_command(app, exit_code);
  add_validate_command(app, exit_code);
  add_completion_command(app, exit_code);
  add_help_command(app, exit_code);
  try {
    app.parse(argc, argv);
  } catch (const CLI::CallForHelp&) {
    print_result(help_of_parsed(app));
  } catch (const CLI::CallForVersion&) {
    print_result(app.version());
  } catch (const CLI::ParseError& error) {
    std::cerr << "qsmpc: " << usage_problem(app, error, argc, argv) << '\n';
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
