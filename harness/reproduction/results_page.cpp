#include "harness/reproduction/results_page.hpp"

#include <optional>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "harness/report/page_frame.hpp"
#include "harness/reproduction/results_table.hpp"
#include "harness/text/html.hpp"

namespace qsmpc::harness {
namespace {

std::string contents(const Reproduction& reproduction) {
  std::string html = "<nav class=\"card\"><ul>\n";
  for (const ExperimentResult& experiment : reproduction.experiments) {
    html += fmt::format("<li><a href=\"#{0}\">{0}</a>: {1}</li>\n", escape_html(experiment.name),
                        escape_html(experiment.title));
  }
  return html + "</ul></nav>\n";
}

constexpr std::string_view kTableBegin =
    "<div class=\"card scroll\" tabindex=\"0\"><table class=\"results\">\n<thead><tr>";

/// A table laid out as in the thesis, with its notes.
std::string grid_html(const ResultGrid& grid) {
  std::string html(kTableBegin);
  html += fmt::format("<th class=\"text\">{}</th>", escape_html(grid.table));
  for (const std::string& column : grid.columns) {
    html += fmt::format("<th>{}</th>", escape_html(column));
  }
  html += "</tr></thead>\n<tbody>\n";
  for (const GridLine& line : grid_lines(grid)) {
    html += fmt::format("<tr{}><td class=\"text\">{}</td>",
                        line.is_published ? " class=\"soft\"" : "", escape_html(line.name));
    for (const std::optional<GridNumber>& number : line.numbers) {
      html += fmt::format("<td>{}</td>", number ? table_number(*number) : "");
    }
    html += "</tr>\n";
  }
  html += "</tbody></table></div>\n";
  for (const GridNote& note : grid_notes(grid)) {
    html += fmt::format("<p class=\"note\">{}: {}</p>\n", escape_html(note.row),
                        escape_html(note.text));
  }
  return html;
}

/// The rows without a place in a table.
std::string list_html(const std::vector<ResultRow>& rows) {
  std::string html;
  for (const ResultRow& row : rows) {
    if (row.place) continue;
    const std::string unit =
        row.unit.empty() ? ""
                         : fmt::format(" <span class=\"soft\">({})</span>", escape_html(row.unit));
    html += fmt::format(
        "<tr><td class=\"text\">{}{}</td><td>{}</td><td>{}</td><td>{}</td>"
        "<td class=\"text\">{}</td></tr>\n",
        escape_html(row.quantity), unit, table_number(row.published), table_number(row.here),
        table_number(ratio_of(row)), escape_html(row.note));
  }
  if (html.empty()) return html;
  return std::string(kTableBegin) +
         "<th>quantity</th><th>published</th><th>here</th><th>ratio</th>"
         "<th class=\"text\">note</th></tr></thead>\n<tbody>\n" +
         html + "</tbody></table></div>\n";
}

std::string rows_html(const ExperimentResult& experiment) {
  std::string html;
  for (const ResultGrid& grid : result_grids(experiment.rows)) html += grid_html(grid);
  return html + list_html(experiment.rows);
}

std::string claims_html(const ExperimentResult& experiment) {
  if (experiment.claims.empty()) return {};
  std::string html = "<div class=\"claims\">\n";
  for (const Claim& claim : experiment.claims) {
    html += fmt::format(
        "<div class=\"tile {0}\"><p><span class=\"badge {0}\">{1}</span> {2}</p>"
        "<p class=\"note\">{3}</p></div>\n",
        claim.holds ? "good" : "bad", claim.holds ? "holds" : "does not hold",
        escape_html(claim.statement), escape_html(claim.evidence));
  }
  return html + "</div>\n";
}

std::string figures_html(const ExperimentResult& experiment) {
  std::string html;
  for (const ResultFigure& figure : experiment.figures) {
    html += fmt::format("<h3>{}</h3>\n<p class=\"note\">{} <a href=\"{}\">{}</a></p>\n",
                        escape_html(figure.title), escape_html(figure.caption),
                        url_beside(figure.file), escape_html(figure.file));
    html += "<div class=\"grid\">\n";
    for (const Panel& panel : figure.panels) html += panel_figure(panel);
    html += "</div>\n";
  }
  return html;
}

std::string experiment_html(const ExperimentResult& experiment) {
  std::string html = fmt::format("<section id=\"{0}\">\n<h2>{0}: {1}</h2>\n",
                                 escape_html(experiment.name), escape_html(experiment.title));
  for (const std::string& remark : experiment.remarks) {
    html += fmt::format("<p>{}</p>\n", escape_html(remark));
  }
  html += claims_html(experiment) + rows_html(experiment) + figures_html(experiment);
  return html + "</section>\n";
}

}  // namespace

std::string results_page(const Reproduction& reproduction) {
  const std::string title = "The thesis’s experiments, reproduced";
  std::string html = "<h1>" + title + "</h1>\n";
  html += fmt::format("<p class=\"kicker\">{}</p>\n", escape_html(circumstances(reproduction)));
  if (!reproduction.complete) {
    html += "<p class=\"outcome\">Not all of the requested experiments have finished.</p>\n";
  }
  html += contents(reproduction);
  for (const ExperimentResult& experiment : reproduction.experiments) {
    html += experiment_html(experiment);
  }
  return framed_page({.title = title, .version = reproduction.version}, html);
}

}  // namespace qsmpc::harness
