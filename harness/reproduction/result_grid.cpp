#include "harness/reproduction/result_grid.hpp"

#include <algorithm>
#include <cstddef>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace qsmpc::harness {
namespace {

/// The name of the table row that `row` belongs to, with its unit.
std::string place_name(const ResultRow& row) {
  return row.unit.empty() ? row.place->row : fmt::format("{} ({})", row.place->row, row.unit);
}

/// The notes on the numbers of a row, with the columns they apply to unless they apply to all.
std::string notes_of(const ResultGrid& grid, const ResultGrid::Row& row) {
  std::vector<std::pair<std::string, std::vector<std::string>>> notes;
  for (std::size_t k = 0; k < grid.columns.size(); ++k) {
    const ResultRow* cell = row.cells[k];
    if (cell == nullptr || cell->note.empty()) continue;
    const auto same = std::ranges::find(notes, cell->note, &decltype(notes)::value_type::first);
    auto& columns = same == notes.end()
                        ? notes.emplace_back(cell->note, decltype(same->second){}).second
                        : same->second;
    columns.push_back(grid.columns[k]);
  }
  std::string text;
  for (const auto& [note, columns] : notes) {
    text += text.empty() ? "" : "; ";
    text += note;
    if (columns.size() < grid.columns.size()) {
      text += fmt::format(" ({})", fmt::join(columns, ", "));
    }
  }
  return text;
}

/// A line of a table: `number` applied to each cell.
template <class Number>
GridLine line_of(const std::string& name, const ResultGrid::Row& row, const Number& number) {
  GridLine line{.name = name};
  for (const ResultRow* cell : row.cells) {
    line.numbers.emplace_back();
    if (cell != nullptr) line.numbers.back().emplace(number(*cell));
  }
  return line;
}

}  // namespace

std::vector<ResultGrid> result_grids(const std::vector<ResultRow>& rows) {
  std::vector<ResultGrid> grids;
  for (const ResultRow& row : rows) {
    if (!row.place) continue;
    auto grid = std::ranges::find(grids, row.place->table, &ResultGrid::table);
    if (grid == grids.end()) grid = grids.insert(grid, {.table = row.place->table});
    if (std::ranges::find(grid->columns, row.place->column) == grid->columns.end()) {
      grid->columns.push_back(row.place->column);
    }
    const std::string name = place_name(row);
    if (std::ranges::find(grid->rows, name, &ResultGrid::Row::name) == grid->rows.end()) {
      grid->rows.push_back({.name = name});
    }
  }
  for (const ResultRow& row : rows) {
    if (!row.place) continue;
    ResultGrid& grid = *std::ranges::find(grids, row.place->table, &ResultGrid::table);
    const std::string name = place_name(row);
    ResultGrid::Row& line = *std::ranges::find(grid.rows, name, &ResultGrid::Row::name);
    line.cells.resize(grid.columns.size(), nullptr);
    const auto column = std::ranges::find(grid.columns, row.place->column) - grid.columns.begin();
    line.cells[static_cast<std::size_t>(column)] = &row;
  }
  return grids;
}

std::vector<GridLine> grid_lines(const ResultGrid& grid) {
  std::vector<GridLine> lines;
  for (const ResultGrid::Row& row : grid.rows) {
    const bool published = std::ranges::any_of(row.cells, [](const ResultRow* cell) {
      return cell != nullptr && cell->published.has_value();
    });
    if (published) {
      lines.push_back(line_of(row.name + ": published", row,
                              [](const ResultRow& cell) { return cell.published; }));
      lines.back().is_published = true;
    }
    lines.push_back(line_of(row.name + (published ? ": here" : ""), row,
                            [](const ResultRow& cell) { return std::optional(cell.here); }));
  }
  return lines;
}

std::vector<GridNote> grid_notes(const ResultGrid& grid) {
  std::vector<GridNote> notes;
  for (const ResultGrid::Row& row : grid.rows) {
    std::string text = notes_of(grid, row);
    if (!text.empty()) notes.push_back({.row = row.name, .text = std::move(text)});
  }
  return notes;
}

}  // namespace qsmpc::harness
