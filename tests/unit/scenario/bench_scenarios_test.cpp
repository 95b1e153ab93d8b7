// The program accepts the scenario files timed by scripts/bench-ocp.
#include <filesystem>

#include <gtest/gtest.h>

#include "harness/scenario/scenario_file.hpp"

namespace qsmpc::harness {
namespace bench_scenarios_test {

TEST(BenchScenarios, all_load_and_are_driven_without_a_simulator) {
  int files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(std::string(QSMPC_SOURCE_DIR) +
                                                               "/tests/bench/scenarios")) {
    const std::string path = entry.path().string();
    for (const InputError::Where& problem : validate_scenario_file(path)) {
      ADD_FAILURE() << path << ":" << problem.line << ": " << problem.key << ": " << problem.found;
    }
    const Scenario scenario = load_scenario(path);
    EXPECT_EQ(scenario.name, entry.path().stem().string());
    EXPECT_EQ(scenario.plant.kind, "analytic") << path;
    ++files;
  }
  EXPECT_GE(files, 2);
}

}  // namespace bench_scenarios_test
}  // namespace qsmpc::harness
