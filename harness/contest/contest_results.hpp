// A contest's results as files and terminal output.
#pragma once

#include <string>

#include "harness/contest/standings.hpp"

namespace qsmpc::harness {

/// The text of contest.json: one object with stable keys, ending in a newline. Non-finite numbers
/// are null. Only the `ocp_ms` keys hold wall-clock values: everything else is reproducible, unless
/// a deadline cut plans short.
[[nodiscard]] std::string contest_json(const ContestResults& results);

/// The text of contest.csv: one line per cell and controller, and one per controller over all
/// cells, with scenario, plant and noise empty. Wall-clock values are in the last columns.
[[nodiscard]] std::string contest_csv(const ContestResults& results);

/// The table over all cells and the summary of each controller, in lines of at most 110 columns.
[[nodiscard]] std::string contest_table(const ContestResults& results);

}  // namespace qsmpc::harness
