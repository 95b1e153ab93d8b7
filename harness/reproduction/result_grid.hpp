// Tables laid out as in the thesis, independent of the output format.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "harness/reproduction/result.hpp"

namespace qsmpc::harness {

/// A table laid out as in the thesis.
struct ResultGrid {
  struct Row {
    std::string name;  ///< with the unit
    /// One per column; nullptr if there is no such quantity.
    std::vector<const ResultRow*> cells{};
  };
  std::string table;
  std::vector<std::string> columns{};
  std::vector<Row> rows{};
};

/// The tables in which `rows` have places, with rows and columns in order of first appearance. They
/// point into `rows`.
[[nodiscard]] std::vector<ResultGrid> result_grids(const std::vector<ResultRow>& rows);

/// The content of a cell; nothing if there is no value.
using GridNumber = std::optional<double>;

/// A line of a printed table: a row as published, or as measured here.
struct GridLine {
  std::string name;
  bool is_published = false;
  std::vector<std::optional<GridNumber>> numbers{};  ///< one per column; nothing: no such quantity
};

/// The lines of `grid`: each row as published, if anything is, and below it as measured here.
[[nodiscard]] std::vector<GridLine> grid_lines(const ResultGrid& grid);

/// A note on the numbers of a row.
struct GridNote {
  std::string row;
  std::string text;
};

[[nodiscard]] std::vector<GridNote> grid_notes(const ResultGrid& grid);

}  // namespace qsmpc::harness
