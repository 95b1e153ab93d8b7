#include "harness/cli/scenario_arguments.hpp"

#include "harness/text/number_parse.hpp"

namespace qsmpc::harness {

void add_scenario_argument(CLI::App& command, std::string& scenario) {
  command.add_option("scenario", scenario, "a scenario file, or the name of a shipped one")
      ->required();
}

void add_set_option(CLI::App& command, std::vector<std::string>& overrides) {
  command.add_option("--set", overrides, "KEY=VALUE: replaces a key of the scenario")
      ->allow_extra_args(false);
}

void add_seed_option(CLI::App& command, std::optional<std::uint64_t>& seed,
                     const std::string& words) {
  // The parser itself takes -1 for the largest number.
  const auto problem = [](const std::string& text) -> std::string {
    if (parse_integer<std::uint64_t>(text)) return {};
    return "found " + text + ", expected a whole number from 0 to 18446744073709551615";
  };
  command.add_option("--seed", seed, words)->check(CLI::Validator(problem, "", "seed"));
}

}  // namespace qsmpc::harness
