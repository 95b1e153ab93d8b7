#include "harness/cli/scenario_arguments.hpp"

namespace qsmpc::harness {

void add_scenario_argument(CLI::App& command, std::string& scenario) {
  command.add_option("scenario", scenario, "a scenario file, or the name of a shipped one")
      ->required();
}

void add_set_option(CLI::App& command, std::vector<std::string>& overrides) {
  command.add_option("--set", overrides, "KEY=VALUE: replaces a key of the scenario")
      ->allow_extra_args(false);
}

}  // namespace qsmpc::harness
