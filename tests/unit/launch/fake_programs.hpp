// Shell scripts in place of programs of the system.
#pragma once

#include <cstdlib>
#include <filesystem>
#include <string>

#include "tests/support/processes.hpp"
#include "tests/support/temporary_folder.hpp"

namespace qsmpc::testing {

/// Puts a folder of scripts before PATH while it lives.
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

  /// `name` runs `body` as sh does. Each call is a line of `calls`, its arguments after its name.
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
