// A reproduction as text: for a terminal, as JSON for programs, as Markdown for docs/results.md.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "harness/reproduction/result.hpp"

namespace qsmpc::harness {

/// Rows beside the published values, claims and remarks, for people.
[[nodiscard]] std::string results_table(const Reproduction& reproduction);

/// {"rows": [{"experiment", "quantity", "unit", "published", "here", "ratio", "note",
/// "place"}, …], "claims": […], "figures": […], …}, one object, ending in a new line. What is not
/// there is null.
[[nodiscard]] std::string results_json(const Reproduction& reproduction);

/// A table of the thesis's own shape.
struct ResultGrid {
  struct Row {
    std::string name;  ///< with the unit
    /// One a column; nullptr where there is no such quantity.
    std::vector<const ResultRow*> cells{};
  };
  std::string table;
  std::vector<std::string> columns{};
  std::vector<Row> rows{};
};

/// The tables that `rows` have places in, rows and columns in the order in which they come first.
/// They point into `rows`.
[[nodiscard]] std::vector<ResultGrid> result_grids(const std::vector<ResultRow>& rows);

/// As Markdown: rows with a place as tables, the others as a list. figures: the folder of the
/// figures, relative to where the text will be.
[[nodiscard]] std::string results_markdown(const Reproduction& reproduction,
                                           const std::string& figures);

/// "intel …, 2 cores, gcc 12.2.0; 50 seeds, 2 threads": what the numbers depend on.
[[nodiscard]] std::string circumstances(const Reproduction& reproduction);

/// A number as tables show it: up to four digits, "–" for what is not there or not finite.
[[nodiscard]] std::string table_number(std::optional<double> value);

}  // namespace qsmpc::harness
