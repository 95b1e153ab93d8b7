#include "harness/report/table_page.hpp"

#include <algorithm>
#include <cmath>
#include <string_view>

#include <fmt/format.h>

#include "harness/report/html.hpp"
#include "harness/report/numbers.hpp"
#include "harness/report/page_frame.hpp"

namespace qsmpc {
namespace {

// The heads of rows stay in sight while a telephone scrolls the rest. On paper nothing scrolls.
constexpr std::string_view kTableStyle = R"css(
.results tbody th {
  position: sticky; left: 0; background: var(--card); font-weight: 400; text-align: left;
  white-space: normal; overflow-wrap: break-word; min-width: 7.5em; max-width: 22em;
}
.results thead th { white-space: normal; overflow-wrap: normal; vertical-align: bottom; }
.results thead th.text { min-width: 7.5em; }
.card.scroll { margin-bottom: 14px; }
.grid > figure { max-width: 640px; }
.grid { margin-bottom: 14px; }
.grid + .grid { margin-top: -2px; }
.results th.text, .results td.text { overflow-wrap: break-word; }
.results td.text { min-width: 9em; }
.results code { font: 0.84rem/1.4 ui-monospace, "Liberation Mono", Menlo, monospace; white-space: nowrap; }
.results td.text:last-child { min-width: 12em; }
.scroll:focus-visible, summary:focus-visible, a:focus-visible {
  outline: 3px solid var(--c0); outline-offset: 2px;
}
h3.name { margin: 20px 0 6px; }
@media (max-width: 600px) { .results tbody th { max-width: 9em; } }
@media print {
  @page { size: A4 landscape; margin: 12mm; }
  :root {
    --ground: #ffffff; --card: #ffffff; --ink: #000000; --soft: #444444; --edge: #b8b8b8;
    --grid: #dddddd; --free: #ffffff; --good: #00694c; --bad: #b03a00;
    --c0: #0072b2; --c1: #d98200; --c2: #009e73; --c3: #b8568f; --c4: #d55e00; --c5: #3a9bd1;
  }
  body { padding: 0; font-size: 10pt; }
  .scroll { overflow: visible; }
  .results th, .results td, .results tbody th { position: static; font-size: 8pt; padding-right: 6px; }
  h2, h3, .note { break-after: avoid; }
  .card.scroll { break-inside: auto; }
  .results td.text:last-child, .results code { font-size: 8pt; }
  tr, figure { break-inside: avoid; }
}
)css";

constexpr std::string_view kHeadEnd = "</head>";

}  // namespace

std::string table_page_head(const std::string& title) {
  std::string head = page_head(title);
  return head.insert(head.find(kHeadEnd), fmt::format("<style>{}</style>\n", kTableStyle));
}

std::string verdict_html(const PageVerdict& verdict) {
  std::string html = fmt::format("<div class=\"outcome {}\"><span class=\"badge\">{} {}</span>",
                                 verdict.is_good ? "good" : "bad", verdict.is_good ? "✓" : "✕",
                                 escape_html(verdict.title));
  for (const std::string& sentence : verdict.sentences) {
    html += "<p>" + escape_html(sentence) + "</p>";
  }
  return html + "</div>\n";
}

std::string table_html(const PageTable& table) {
  const auto classes = [&](std::size_t column) {
    const bool is_text =
        column == 0 || std::ranges::find(table.text_columns, column) != table.text_columns.end();
    return is_text ? " class=\"text\"" : "";
  };
  std::string html = fmt::format(
      "<div class=\"card scroll\" role=\"region\" tabindex=\"0\" aria-label=\"{}\">"
      "<table class=\"results\">\n<thead><tr>",
      escape_html(table.label));
  for (std::size_t n = 0; n < table.heads.size(); ++n) {
    html += fmt::format("<th scope=\"col\"{}>{}</th>", classes(n), table.heads[n]);
  }
  html += "</tr></thead>\n<tbody>\n";
  for (const std::vector<std::string>& row : table.rows) {
    html += "<tr>";
    for (std::size_t n = 0; n < row.size(); ++n) {
      html += n == 0 ? fmt::format("<th scope=\"row\">{}</th>", row[n])
                     : fmt::format("<td{}>{}</td>", classes(n), row[n]);
    }
    html += "</tr>\n";
  }
  return html + "</tbody></table></div>\n";
}

std::string section_head(const std::string& heading, const std::string& note) {
  std::string html = "<h2>" + escape_html(heading) + "</h2>\n";
  if (!note.empty()) html += "<p class=\"note\">" + escape_html(note) + "</p>\n";
  return html;
}

std::string number_html(double value) { return std::isfinite(value) ? format_short(value) : "–"; }

std::string interval_html(const RateInterval& limits) {
  return fmt::format("<span class=\"soft\">[{}, {}]</span>", number_html(limits.lower),
                     number_html(limits.upper));
}

}  // namespace qsmpc
