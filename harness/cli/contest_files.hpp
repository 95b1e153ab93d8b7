// What a contest's stores say, as files beside them.
#pragma once

#include <string>

#include "harness/contest/contest.hpp"
#include "harness/contest/standings.hpp"
#include "harness/contest/tuning.hpp"

namespace qsmpc::harness {

/// Where in a contest's folder the search's drives are, and those that are timed: folders of
/// campaigns. The contest's own drives are in the folder itself.
inline constexpr const char* kTuningFolder = "tuning";
inline constexpr const char* kTimingFolder = "timing";

/// Reads the stores in `folder` and writes contest.html, contest.json, contest.csv and the figure,
/// each in one piece, and what `qsmpc campaign` writes of the drives. `is_timed`: whether the timed
/// drives are done. Throws as StoreReader does, and IoError.
ContestResults write_contest_files(const Contest& contest, const TuningResult& tuning,
                                   const std::string& folder, bool is_timed);

/// Where they are, for a terminal.
[[nodiscard]] std::string contest_files_text(const std::string& folder);

}  // namespace qsmpc::harness
