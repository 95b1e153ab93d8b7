#include "harness/reproduction/results_table.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "harness/text/number_format.hpp"
#include "harness/text/printable.hpp"
#include "harness/text/text_width.hpp"

namespace qsmpc::harness {
namespace {

constexpr std::size_t kQuantityWidth = 74;
constexpr std::size_t kNumberWidth = 12;
constexpr int kDigits = 4;

std::string with_unit(const ResultRow& row) {
  return row.unit.empty() ? row.quantity : fmt::format("{} ({})", row.quantity, row.unit);
}

/// The name of its row in a table.
std::string place_name(const ResultRow& row) {
  return row.unit.empty() ? row.place->row : fmt::format("{} ({})", row.place->row, row.unit);
}

/// Plain ASCII, so that columns line up wherever they are printed.
std::string plain_number(std::optional<double> value) {
  if (!value || !std::isfinite(*value)) return "-";
  return fmt::format("{:.{}g}", *value, kDigits);
}

std::string experiment_text(const ExperimentResult& experiment) {
  std::string text =
      fmt::format("\n{}: {} ({:.1f} s)\n", experiment.name, experiment.title, experiment.seconds);
  text += fmt::format("  {}{:>{}}{:>{}}{:>{}}\n", padded("", kQuantityWidth), "published",
                      kNumberWidth, "here", kNumberWidth, "ratio", kNumberWidth);
  for (const ResultRow& row : experiment.rows) {
    text += fmt::format("  {}{:>{}}{:>{}}{:>{}}\n", padded(with_unit(row), kQuantityWidth),
                        plain_number(row.published), kNumberWidth, plain_number(row.here),
                        kNumberWidth, plain_number(ratio_of(row)), kNumberWidth);
  }
  for (const Claim& claim : experiment.claims) {
    text += fmt::format("  {} {}\n          {}\n", claim.holds ? "[holds]" : "[FAILS]",
                        claim.statement, claim.evidence);
  }
  return text;
}

/// `text` as part of a cell or a paragraph of Markdown.
std::string escape_markdown(const std::string& text) {
  std::string escaped;
  for (const char c : text) {
    if (c == '|' || c == '*' || c == '_' || c == '<' || c == '`' || c == '\\') escaped += '\\';
    escaped += c;
  }
  return escaped;
}

/// The rows without a place in a table.
std::string list_markdown(const std::vector<ResultRow>& rows) {
  std::string text;
  for (const ResultRow& row : rows) {
    if (row.place) continue;
    text += fmt::format("| {} | {} | {} | {} | {} |\n", escape_markdown(with_unit(row)),
                        table_number(row.published), table_number(row.here),
                        table_number(ratio_of(row)), escape_markdown(row.note));
  }
  if (text.empty()) return text;
  return "\n| quantity | published | here | ratio | note |\n"
         "| --- | ---: | ---: | ---: | --- |\n" +
         text;
}

/// What there is to know of the numbers of a row, and of which columns where not of all.
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

/// A line of a table: what `number` says of each cell.
template <class Number>
std::string grid_line(const std::string& name, const ResultGrid::Row& row, const Number& number) {
  std::string text = "| " + escape_markdown(name);
  for (const ResultRow* cell : row.cells) {
    text += " | " + (cell == nullptr ? std::string() : table_number(number(*cell)));
  }
  return text + " |\n";
}

/// The columns of the thesis across, its rows down, each as published and below it as it is here.
std::string grid_markdown(const ResultGrid& grid) {
  std::string text = fmt::format("\n| {} |", escape_markdown(grid.table));
  std::string rule = "\n| --- |";
  for (const std::string& column : grid.columns) {
    text += " " + escape_markdown(column) + " |";
    rule += " ---: |";
  }
  text += rule + "\n";
  std::string notes;
  for (const ResultGrid::Row& row : grid.rows) {
    const bool published = std::ranges::any_of(row.cells, [](const ResultRow* cell) {
      return cell != nullptr && cell->published.has_value();
    });
    if (published) {
      text += grid_line(row.name + ": published", row,
                        [](const ResultRow& cell) { return cell.published; });
    }
    text += grid_line(row.name + (published ? ": here" : ""), row,
                      [](const ResultRow& cell) { return std::optional(cell.here); });
    const std::string note = notes_of(grid, row);
    if (!note.empty()) {
      notes += fmt::format("- {}: {}\n", escape_markdown(row.name), escape_markdown(note));
    }
  }
  return notes.empty() ? text : text + "\n" + notes;
}

std::string experiment_markdown(const ExperimentResult& experiment, const std::string& figures) {
  std::string text =
      fmt::format("\n## {}: {}\n", experiment.name, escape_markdown(experiment.title));
  for (const std::string& remark : experiment.remarks) {
    text += fmt::format("\n{}\n", escape_markdown(remark));
  }
  for (const ResultGrid& grid : result_grids(experiment.rows)) text += grid_markdown(grid);
  text += list_markdown(experiment.rows);
  if (!experiment.claims.empty()) text += "\n| claim | holds | evidence |\n| --- | --- | --- |\n";
  for (const Claim& claim : experiment.claims) {
    text += fmt::format("| {} | {} | {} |\n", escape_markdown(claim.statement),
                        claim.holds ? "yes" : "**no**", escape_markdown(claim.evidence));
  }
  for (const ResultFigure& figure : experiment.figures) {
    text += fmt::format("\n![{}]({}/{})\n", escape_markdown(figure.title), figures, figure.file);
    if (!figure.caption.empty()) text += fmt::format("\n*{}*\n", escape_markdown(figure.caption));
  }
  return text;
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

std::string table_number(std::optional<double> value) {
  return value && std::isfinite(*value) ? format_short(*value, kDigits) : "–";
}

std::string circumstances(const Reproduction& reproduction) {
  return fmt::format("{}, {} cores, {}; {} seeds a drive, {} threads; {:.0f} s in all",
                     printable(reproduction.machine.processor), reproduction.machine.cores,
                     reproduction.machine.compiler, reproduction.seeds, reproduction.threads,
                     reproduction.seconds);
}

std::string results_table(const Reproduction& reproduction) {
  std::string text = "reproduced: " + circumstances(reproduction) + "\n";
  for (const ExperimentResult& experiment : reproduction.experiments) {
    text += experiment_text(experiment);
  }
  return text;
}

std::string results_markdown(const Reproduction& reproduction, const std::string& figures) {
  std::string text =
      fmt::format("qsmpc {}; {}.\n", reproduction.version, circumstances(reproduction));
  for (const ExperimentResult& experiment : reproduction.experiments) {
    text += experiment_markdown(experiment, figures);
  }
  return text;
}

}  // namespace qsmpc::harness
