// The fuzz targets: every reader of external input. A target gets bytes and reads them or refuses
// them in the documented way; anything else is a finding. Readers of binary files get edited copies
// of a sound file (edited_files.hpp).
#pragma once

#include <string>
#include <vector>

namespace qsmpc::testing {

struct FuzzTarget {
  std::string name;
  /// Throws if `bytes` were neither read nor refused as they should be. Any other exception, a
  /// crash, a sanitizer report and a hang are findings as well.
  void (*read)(const std::string& bytes);
};

[[nodiscard]] const std::vector<FuzzTarget>& fuzz_targets();

/// The target of that name. Throws std::invalid_argument, listing the existing names.
[[nodiscard]] const FuzzTarget& fuzz_target(const std::string& name);

/// The initial corpus of `target`, sorted: the files in tests/fuzz/seeds/NAME and, if the program
/// ships any, in models/NAMEs.
[[nodiscard]] std::vector<std::string> fuzz_seeds(const FuzzTarget& target);

}  // namespace qsmpc::testing
