// Shared by the scenario tests: a short valid scenario.
#pragma once

#include <filesystem>
#include <fstream>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "harness/errors.hpp"
#include "harness/scenario/scenario_file.hpp"
#include "tests/support/temporary_folder.hpp"

namespace qsmpc::harness {

/// The smallest scenario: lines 1 to 5. Tests append lines.
inline const std::string minimal_text =
    "name: test\n"
    "model: {system: dubins}\n"
    "plant: {kind: analytic, mjcf: \"\"}\n"
    "initial_state: {mean: [0, 0, 0]}\n"
    "target: {state: [5, 0, 0]}\n";

/// The minimal scenario, changed as by `--set`.
inline Scenario minimal_with(const std::vector<std::string>& overrides) {
  return parse_scenario(minimal_text, {.file = "t.yaml", .overrides = overrides});
}

/// The problem that `parse_scenario` reports; fails the test if there is none.
inline InputError::Where refusal_of(const std::string& text,
                                    const std::vector<std::string>& overrides = {}) {
  try {
    (void)parse_scenario(text, {.file = "t.yaml", .overrides = overrides});
  } catch (const InputError& error) {
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
    return error.where();
  }
  ADD_FAILURE() << "accepted:\n" << text.substr(0, 400);
  return {};
}

using testing::TemporaryFolder;

inline std::string content_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

}  // namespace qsmpc::harness
