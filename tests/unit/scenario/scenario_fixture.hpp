// What the scenario tests share: a short valid scenario, and folders that clean up after
// themselves.
#pragma once

#include <filesystem>
#include <fstream>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "harness/errors.hpp"
#include "harness/scenario/scenario_file.hpp"

namespace qsmpc {

/// The least that is a scenario: lines 1 to 5. Tests put more lines after it.
inline const std::string minimal_text =
    "name: test\n"
    "model: {system: dubins}\n"
    "plant: {kind: analytic}\n"
    "initial_state: {mean: [0, 0, 0]}\n"
    "target: {state: [5, 0, 0]}\n";

/// What `parse_scenario` says is wrong; fails the test if it says nothing.
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

/// An empty folder that is removed with everything in it.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "qsmpc_scenario_XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("no temporary folder");
    path_ = name;
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  TemporaryFolder(TemporaryFolder&&) = delete;
  TemporaryFolder& operator=(TemporaryFolder&&) = delete;
  ~TemporaryFolder() {
    std::error_code error;
    std::filesystem::remove_all(path_, error);
  }

  [[nodiscard]] std::string operator/(const std::string& name) const { return path_ + "/" + name; }
  [[nodiscard]] const std::string& path() const { return path_; }

  /// Writes a file into it and returns its path.
  [[nodiscard]] std::string file(const std::string& name, const std::string& text) const {
    std::ofstream(*this / name, std::ios::binary) << text;
    return *this / name;
  }

 private:
  std::string path_;
};

inline std::string content_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

}  // namespace qsmpc
