#include "harness/report/table_page.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "harness/text/html.hpp"
#include "harness/text/number_format.hpp"

namespace qsmpc::harness {

std::string verdict_html(const PageVerdict& verdict) {
  const bool is_good = verdict.mood == PageMood::kGood;
  const bool is_bad = verdict.mood == PageMood::kBad;
  std::string html = fmt::format("<div class=\"outcome{}\"><span class=\"badge\">{} {}</span>",
                                 is_good  ? " good"
                                 : is_bad ? " bad"
                                          : "",
                                 is_good  ? "✓"
                                 : is_bad ? "✕"
                                          : "!",
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

}  // namespace qsmpc::harness
