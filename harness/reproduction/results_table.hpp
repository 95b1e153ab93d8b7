// A reproduction as text: for a terminal, as JSON for programs, as Markdown for docs/results.md.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "harness/reproduction/result.hpp"
#include "harness/reproduction/result_grid.hpp"

namespace qsmpc::harness {

/// For a terminal: tables laid out as in the thesis, other rows beside the published values, claims
/// and remarks.
[[nodiscard]] std::string results_table(const Reproduction& reproduction);

/// {"rows": [{"experiment", "quantity", "unit", "published", "here", "ratio", "note",
/// "place"}, …], "claims": […], "figures": […], …}, one object, ending in a newline. Missing values
/// are null.
[[nodiscard]] std::string results_json(const Reproduction& reproduction);

/// As Markdown: rows with a place as tables, the others as a list. figures: the folder of the
/// figures, relative to that of the text.
[[nodiscard]] std::string results_markdown(const Reproduction& reproduction,
                                           const std::string& figures);

/// "intel …, 2 cores, gcc 12.2.0; 50 seeds, 2 threads": what the numbers depend on.
[[nodiscard]] std::string circumstances(const Reproduction& reproduction);

/// A number as tables show it: up to four digits, "–" if missing or not finite.
[[nodiscard]] std::string table_number(std::optional<double> value);

}  // namespace qsmpc::harness
