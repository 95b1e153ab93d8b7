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
#include "harness/text/utf8.hpp"

namespace qsmpc::harness {
namespace {

constexpr std::size_t kQuantityWidth = 74;
constexpr std::size_t kNumberWidth = 12;
constexpr int kDigits = 4;
constexpr std::size_t kTextWidth = 110;  // of a table on a terminal, if it can be divided
constexpr std::size_t kColumnGap = 2;

std::string with_unit(const ResultRow& row) {
  return row.unit.empty() ? row.quantity : fmt::format("{} ({})", row.quantity, row.unit);
}

/// Plain ASCII, so that columns align on any output.
std::string plain_number(std::optional<double> value) {
  if (!value || !std::isfinite(*value)) return "-";
  return fmt::format("{:.{}g}", *value, kDigits);
}

std::string plain_cell(const std::optional<GridNumber>& number) {
  return number ? plain_number(*number) : std::string();
}

/// Width in characters of each column on a terminal: the first holds names, the others numbers.
std::vector<std::size_t> text_widths(const ResultGrid& grid, const std::vector<GridLine>& lines) {
  std::vector<std::size_t> widths{utf8_characters(grid.table)};
  for (const std::string& column : grid.columns) widths.push_back(utf8_characters(column));
  for (const GridLine& line : lines) {
    widths[0] = std::max(widths[0], utf8_characters(line.name));
    for (std::size_t k = 0; k < line.numbers.size(); ++k) {
      widths[k + 1] = std::max(widths[k + 1], plain_cell(line.numbers[k]).size());
    }
  }
  return widths;
}

/// A number's cell, or its column's header, aligned right.
std::string right(const std::string& text, std::size_t width) {
  return std::string(kColumnGap + width - utf8_characters(text), ' ') + text;
}

/// The table laid out as in the thesis; columns that do not fit a terminal continue below.
std::string grid_text(const ResultGrid& grid) {
  const std::vector<GridLine> lines = grid_lines(grid);
  const std::vector<std::size_t> widths = text_widths(grid, lines);
  std::string text;
  for (std::size_t first = 0; first < grid.columns.size();) {
    std::size_t end = first;
    for (std::size_t room = widths[0]; end < grid.columns.size(); ++end) {
      room += kColumnGap + widths[end + 1];
      if (room > kTextWidth && end > first) break;
    }
    text += "  " + padded(grid.table, widths[0]);
    for (std::size_t k = first; k < end; ++k) text += right(grid.columns[k], widths[k + 1]);
    text += "\n";
    for (const GridLine& line : lines) {
      text += "  " + padded(line.name, widths[0]);
      for (std::size_t k = first; k < end; ++k) {
        text += right(plain_cell(line.numbers[k]), widths[k + 1]);
      }
      text += "\n";
    }
    first = end;
  }
  return text;
}

/// The rows without a place in a table.
std::string list_text(const std::vector<ResultRow>& rows) {
  std::string text;
  for (const ResultRow& row : rows) {
    if (row.place) continue;
    text += fmt::format("  {}{:>{}}{:>{}}{:>{}}\n", padded(with_unit(row), kQuantityWidth),
                        plain_number(row.published), kNumberWidth, plain_number(row.here),
                        kNumberWidth, plain_number(ratio_of(row)), kNumberWidth);
  }
  if (text.empty()) return text;
  return fmt::format("  {}{:>{}}{:>{}}{:>{}}\n", padded("", kQuantityWidth), "published",
                     kNumberWidth, "here", kNumberWidth, "ratio", kNumberWidth) +
         text;
}

std::string experiment_text(const ExperimentResult& experiment) {
  std::string text =
      fmt::format("\n{}: {} ({:.1f} s)\n", experiment.name, experiment.title, experiment.seconds);
  for (const ResultGrid& grid : result_grids(experiment.rows)) text += grid_text(grid);
  text += list_text(experiment.rows);
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

/// The thesis's columns across and its rows down, each row as published and, below it, as measured
/// here.
std::string grid_markdown(const ResultGrid& grid) {
  std::string text = fmt::format("\n| {} |", escape_markdown(grid.table));
  std::string rule = "\n| --- |";
  for (const std::string& column : grid.columns) {
    text += " " + escape_markdown(column) + " |";
    rule += " ---: |";
  }
  text += rule + "\n";
  for (const GridLine& line : grid_lines(grid)) {
    text += "| " + escape_markdown(line.name);
    for (const std::optional<GridNumber>& number : line.numbers) {
      text += " | " + (number ? table_number(*number) : std::string());
    }
    text += " |\n";
  }
  std::string notes;
  for (const GridNote& note : grid_notes(grid)) {
    notes += fmt::format("- {}: {}\n", escape_markdown(note.row), escape_markdown(note.text));
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

std::string table_number(std::optional<double> value) {
  return value && std::isfinite(*value) ? format_short(*value, kDigits) : "–";
}

std::string circumstances(const Reproduction& reproduction) {
  return fmt::format("{}, {} cores, {}; {} seeds per drive, {} threads; {:.0f} s in total",
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
