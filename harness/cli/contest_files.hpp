// The results in a contest's stores, as files beside them.
#pragma once

#include <string>

#include "harness/contest/contest.hpp"
#include "harness/contest/standings.hpp"
#include "harness/contest/tuning.hpp"

namespace qsmpc::harness {

/// Subfolders of a contest's folder with the campaigns of the search's drives and of the timed
/// drives. The contest's own drives are in the folder itself.
inline constexpr const char* kTuningFolder = "tuning";
inline constexpr const char* kTimingFolder = "timing";

/// Reads the stores in `folder` and writes contest.html, contest.json, contest.csv and the figure,
/// each atomically, and the files that `qsmpc campaign` writes about the drives. `is_timed`:
/// whether the timed drives are done. Throws as StoreReader does, and IoError.
ContestResults write_contest_files(const Contest& contest, const TuningResult& tuning,
                                   const std::string& folder, bool is_timed);

/// The locations of these files, as text for a terminal.
[[nodiscard]] std::string contest_files_text(const std::string& folder);

}  // namespace qsmpc::harness
