// Shell scripts that stand in for system programs.
#pragma once

#include <cstdlib>
#include <filesystem>
#include <string>

#include "tests/support/processes.hpp"
#include "tests/support/temporary_folder.hpp"

namespace qsmpc::testing {

/// Prepends a folder of scripts to PATH while alive.
class FakePrograms {
 public:
  FakePrograms() : path_(std::getenv("PATH")) {
    setenv("PATH", (folder_.path() + ":" + path_).c_str(), 1);
  }
  FakePrograms(const FakePrograms&) = delete;
  FakePrograms& operator=(const FakePrograms&) = delete;
  FakePrograms(FakePrograms&&) = delete;
  FakePrograms& operator=(FakePrograms&&) = delete;
  ~FakePrograms() { setenv("PATH", path_.c_str(), 1); }

  /// `name` runs `body` in sh. Each call adds a line to `calls`: its name and its arguments.
  void add(const std::string& name, const std::string& body) const {
    const std::string path = folder_.file(name, "#!/bin/sh\necho \"" + name + " $*\" >>'" +
                                                    (folder_ / "calls") + "'\n" + body + "\n");
    std::filesystem::permissions(path, std::filesystem::perms::owner_all);
  }

  [[nodiscard]] std::string calls() const { return text_of(folder_ / "calls"); }

 private:
  TemporaryFolder folder_;
  std::string path_;
};

}  // namespace qsmpc::testing
