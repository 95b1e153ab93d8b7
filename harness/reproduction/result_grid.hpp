// Tables in the shape of the thesis's own, for whatever they are printed on.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "harness/reproduction/result.hpp"

namespace qsmpc::harness {

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

/// What stands in a cell; nothing where a value is not there.
using GridNumber = std::optional<double>;

/// A line of a printed table: a row as published, or as it is here.
struct GridLine {
  std::string name;
  bool is_published = false;
  std::vector<std::optional<GridNumber>> numbers{};  ///< one a column; none: no such quantity
};

/// The lines of `grid`: each row as published, where something is, and below it as it is here.
[[nodiscard]] std::vector<GridLine> grid_lines(const ResultGrid& grid);

/// What there is to know of the numbers of a row.
struct GridNote {
  std::string row;
  std::string text;
};

[[nodiscard]] std::vector<GridNote> grid_notes(const ResultGrid& grid);

}  // namespace qsmpc::harness
