// What is fuzzed: every reader of what comes from outside of the program. Bytes are given to one;
// it reads them or refuses them in the way that it states, and whatever else happens is a finding.
// Readers of binary files are given what edits make of a sound one (edited_files.hpp).
#pragma once

#include <string>
#include <vector>

namespace qsmpc::testing {

struct FuzzTarget {
  std::string name;
  /// Throws where `bytes` were neither read nor refused as they should be. Everything else that
  /// is thrown, a crash, a sanitizer's report and a hang are findings as well.
  void (*read)(const std::string& bytes);
};

[[nodiscard]] const std::vector<FuzzTarget>& fuzz_targets();

/// The target of that name. Throws std::invalid_argument with the names that there are.
[[nodiscard]] const FuzzTarget& fuzz_target(const std::string& name);

/// The files that the fuzzing of `target` begins with, sorted: those in tests/fuzz/seeds/NAME and,
/// where the program comes with some, in models/NAMEs.
[[nodiscard]] std::vector<std::string> fuzz_seeds(const FuzzTarget& target);

}  // namespace qsmpc::testing
