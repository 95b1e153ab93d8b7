#include "harness/report/svg_figure.hpp"

#include <algorithm>
#include <cstddef>
#include <string_view>

#include <fmt/format.h>

#include "harness/report/axis.hpp"
#include "harness/report/html.hpp"

namespace qsmpc {
namespace {

constexpr std::size_t kChartsInRow = 2;
constexpr double kMargin = 14.0;
constexpr double kTitleHeight = 26.0;
constexpr double kLineHeight = 17.0;  // of a note or an entry of the legend
constexpr double kGap = 22.0;         // between rows of charts
constexpr double kSwatchWidth = 28.0;
constexpr std::size_t kNoteColumns = 78;  // characters that fit a line of small print

// Plain colours, those of the page in the light, since few programs but browsers know variables.
constexpr std::string_view kStyle =
    "text{font:12.5px 'Liberation Sans',Arial,Helvetica,sans-serif;fill:#16202a}"
    "text.title{font-size:15px;font-weight:600}text.note,text.label{fill:#55636f}"
    "text.note{font-size:11.5px}text.middle{text-anchor:middle}text.end{text-anchor:end}"
    ".line,.rule,.axis,.grid-line,.points{fill:none}"
    ".line{stroke-width:1.9;stroke-linejoin:round;stroke-linecap:round}"
    ".points{stroke-width:7;stroke-linecap:round}"
    ".dash{stroke-dasharray:7 5;stroke-linecap:butt}"
    ".rule{stroke:#16202a;stroke-width:1.4;stroke-dasharray:2 3}"
    ".axis{stroke:#55636f;stroke-width:1}.grid-line{stroke:#e6ebef;stroke-width:1}"
    ".c0{stroke:#0072b2}.c1{stroke:#d98200}.c2{stroke:#009e73}.c3{stroke:#b8568f}"
    ".c4{stroke:#d55e00}.c5{stroke:#3a9bd1}";

/// `text` in lines of at most kNoteColumns bytes, broken at spaces.
std::vector<std::string> wrapped(const std::string& text) {
  std::vector<std::string> lines;
  for (std::size_t begin = 0; begin < text.size();) {
    std::size_t end = std::min(begin + kNoteColumns, text.size());
    if (end < text.size()) {
      const std::size_t space = text.rfind(' ', end);
      if (space != std::string::npos && space > begin) end = space;
    }
    lines.push_back(text.substr(begin, end - begin));
    begin = end < text.size() && text[end] == ' ' ? end + 1 : end;
  }
  return lines;
}

struct LegendEntry {
  std::string classes;
  std::string name;
};

std::vector<LegendEntry> legend_of(const Chart& chart) {
  std::vector<LegendEntry> entries;
  for (const Series& series : chart.series) {
    entries.push_back({.classes = line_classes(series), .name = series.name});
  }
  for (const Rule& rule : chart.rules) {
    if (!rule.name.empty() && is_drawable(rule.value)) {
      entries.push_back({.classes = "rule", .name = rule.name});
    }
  }
  return entries;
}

/// Height of what stands above the drawing.
double head_height(const Chart& chart) {
  const auto lines = wrapped(chart.note).size() + legend_of(chart).size();
  return kTitleHeight + kLineHeight * static_cast<double>(lines);
}

std::string text_at(std::string_view classes, double x, double y, const std::string& text) {
  return fmt::format("<text class=\"{}\" x=\"{:.1f}\" y=\"{:.1f}\">{}</text>\n", classes, x, y,
                     escape_html(text));
}

std::string head_svg(const Chart& chart, double x, double y) {
  y += kTitleHeight - 10.0;
  std::string svg = text_at("title", x, y, chart.title);
  for (const std::string& line : wrapped(chart.note)) {
    y += kLineHeight;
    svg += text_at("note", x, y, line);
  }
  for (const LegendEntry& entry : legend_of(chart)) {
    y += kLineHeight;
    const bool points = entry.classes.starts_with("points");
    svg += fmt::format("<path class=\"{}\" d=\"M{:.1f} {:.1f}h{}\"/>", entry.classes,
                       points ? x + kSwatchWidth / 2.0 : x, y - 4.0, points ? 0.0 : kSwatchWidth);
    svg += text_at("", x + kSwatchWidth + 8.0, y, entry.name);
  }
  return svg;
}

std::string chart_svg(const Chart& chart, double x, double y, double head) {
  return head_svg(chart, x, y) + (has_points(chart) ? chart_drawing(chart, x, y + head)
                                                    : text_at("note", x, y + head + kTitleHeight,
                                                              "No finite values to draw."));
}

}  // namespace

std::string svg_figure(const std::vector<Chart>& charts) {
  const std::size_t in_row = std::clamp<std::size_t>(charts.size(), 1, kChartsInRow);
  std::string body;
  double y = kMargin;
  for (std::size_t first = 0; first < charts.size(); first += in_row) {
    const std::size_t end = std::min(first + in_row, charts.size());
    double head = 0.0;
    for (std::size_t n = first; n < end; ++n) head = std::max(head, head_height(charts[n]));
    for (std::size_t n = first; n < end; ++n) {
      const double x = kMargin + static_cast<double>(n - first) * (kChartWidth + kMargin);
      body += chart_svg(charts[n], x, y, head);
    }
    y += head + kChartHeight + (end < charts.size() ? kGap : 0.0);
  }
  const double width = kMargin + static_cast<double>(in_row) * (kChartWidth + kMargin);
  const double height = y + kMargin;
  return fmt::format(
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0:.0f}\" height=\"{1:.0f}\" "
      "viewBox=\"0 0 {0:.0f} {1:.0f}\">\n<style>{2}</style>\n"
      "<rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>\n{3}</svg>\n",
      width, height, kStyle, body);
}

}  // namespace qsmpc
