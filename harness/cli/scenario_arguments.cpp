#include "harness/cli/scenario_arguments.hpp"

#include <algorithm>
#include <iostream>

#include <fmt/format.h>

#include "harness/assembly/chosen_points.hpp"
#include "harness/assembly/memory_need.hpp"
#include "harness/errors.hpp"
#include "harness/scenario/scenario_file.hpp"
#include "harness/text/number_parse.hpp"

namespace qsmpc::harness {

void add_scenario_argument(CLI::App& command, std::string& scenario) {
  command.add_option("scenario", scenario, "a scenario file, or the name of a shipped one")
      ->required();
}

void add_set_option(CLI::App& command, std::vector<std::string>& overrides) {
  command.add_option("--set", overrides, "KEY=VALUE: set a key of the scenario")
      ->allow_extra_args(false);
}

void add_seed_option(CLI::App& command, std::optional<std::uint64_t>& seed,
                     const std::string& words) {
  // The parser itself would read -1 as the largest number.
  const auto problem = [](const std::string& text) -> std::string {
    if (parse_integer<std::uint64_t>(text)) return {};
    return "found " + text + ", expected a whole number from 0 to 18446744073709551615";
  };
  command.add_option("--seed", seed, words)->check(CLI::Validator(problem, "", "seed"));
}

void refuse_beyond_memory(const Scenario& scenario, const std::string& path_or_name,
                          const std::vector<std::string>& overrides, int count) {
  const auto problem = memory_problem(scenario, count, usable_memory());
  if (!problem) return;
  InputError::Where where = place_of_key(path_or_name, overrides, "controller.quantisation");
  where.key = "controller.quantisation";
  where.found = problem->found;
  where.expected = problem->expected;
  throw InputError(where);
}

void refuse_motion(const Scenario& scenario, const std::string& path_or_name,
                   const std::vector<std::string>& overrides, const std::string& command) {
  if (controller::moving_obstacles(scenario.safe_set).empty()) return;
  InputError::Where where = place_of_key(path_or_name, overrides, "safe_set.obstacles");
  where.key = "safe_set.obstacles";
  where.found = "an obstacle with a motion";
  where.expected = fmt::format("static obstacles, for {}", command);
  throw InputError(where);
}

void settle_points(Scenario& scenario, bool quiet) {
  const Scenario::Quantisation asked = scenario.controller.quantisation;
  const auto choice = choose_points(scenario);
  if (!choice || quiet) return;
  if (choice->compressed_points == asked.compressed && choice->state_points == asked.state) {
    std::cerr << fmt::format("qsmpc: all points are needed: {} for the belief, {} kept\n",
                             asked.state, asked.compressed);
    return;
  }
  std::cerr << fmt::format(
      "qsmpc: {} of {} points for the belief, {} of {} kept; in {} trial plans they change "
      "the cost by {:+.2g} %\n",
      choice->state_points, asked.state, choice->compressed_points, asked.compressed,
      choice->places, 100.0 * choice->gap);
}

}  // namespace qsmpc::harness
