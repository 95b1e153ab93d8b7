// Contest files: a path, or the name of a shipped one.
#pragma once

#include <string>
#include <vector>

#include "harness/contest/contest.hpp"
#include "harness/errors.hpp"

namespace qsmpc::harness {

/// The copy of the contest file in the contest's folder.
inline constexpr const char* kContestCopy = "contest.yaml";

/// A contest, with all of its drives checked.
struct LoadedContest {
  Contest contest{};
  Campaign
      search{};  ///< all candidates with the seeds of the tuning; no variants if nothing is chosen
  Campaign drives{};  ///< with the first candidate of each controller
};

/// The path of the contest `path_or_name`. Throws InputError when it is neither a path nor the name
/// of a shipped one.
[[nodiscard]] std::string find_contest(const std::string& path_or_name);

/// Loads the contest with all scenarios, plants and candidates checked. Throws InputError with the
/// first problem.
[[nodiscard]] LoadedContest load_contest(const std::string& path_or_name);

/// All problems of the contest; empty if it is valid.
[[nodiscard]] std::vector<InputError::Where> validate_contest_file(const std::string& path_or_name);

/// Whether `path_or_name` is a file that looks like a contest, or the name of a shipped one.
[[nodiscard]] bool is_contest_file(const std::string& path_or_name);

/// The drives of a loaded contest with the chosen candidates, and the timed drives. Both throw
/// InputError if files have changed since in a way that makes a drive invalid.
[[nodiscard]] Campaign chosen_drives(const Contest& contest, const ContestChoice& choice);
[[nodiscard]] Campaign timed_drives(const Contest& contest, const ContestChoice& choice);

/// The plan as readable text: what is driven and how often. The JSON is one object: the contest's
/// lists, the candidates, and the plans of the search and the contest as printed by `qsmpc campaign
/// --dry-run --json`.
[[nodiscard]] std::string contest_plan_text(const LoadedContest& loaded);
[[nodiscard]] std::string contest_plan_json(const LoadedContest& loaded);

/// "contest rivals: 3 controllers x 2 scenarios x 1 plant x 1 noise level x 20 seeds = 120 drives".
[[nodiscard]] std::string contest_size_text(const LoadedContest& loaded);

}  // namespace qsmpc::harness
