// A contest's results as files and for a terminal.
#pragma once

#include <string>

#include "harness/contest/standings.hpp"

namespace qsmpc::harness {

/// The text of contest.json: stable keys, one object, ending in a new line. Numbers that are not
/// finite are null. Wall-clock values stand under the keys `ocp_ms` alone: everything else is the
/// same in two runs, unless a deadline cut plans short.
[[nodiscard]] std::string contest_json(const ContestResults& results);

/// contest.csv: a line for each cell and controller, and for each controller over all cells, where
/// scenario, plant and noise are empty. Wall-clock values are in the last columns.
[[nodiscard]] std::string contest_csv(const ContestResults& results);

/// The table over all cells and the words about each controller, in lines of at most 110 columns.
[[nodiscard]] std::string contest_table(const ContestResults& results);

}  // namespace qsmpc::harness
