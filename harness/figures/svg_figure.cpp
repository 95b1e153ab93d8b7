#include "harness/figures/svg_figure.hpp"

#include <algorithm>
#include <cstddef>
#include <string_view>

#include <fmt/format.h>

#include "harness/figures/legend.hpp"
#include "harness/text/html.hpp"
#include "harness/text/text_width.hpp"

namespace qsmpc::harness {
namespace {

constexpr std::size_t kPanelsInRow = 2;
constexpr double kMargin = 14.0;
constexpr double kTitleHeight = 26.0;
constexpr double kLineHeight = 17.0;  // of a note or an entry of the legend
constexpr double kGap = 22.0;         // between rows of panels
constexpr double kFigureText = 12.5;
constexpr double kSmallFigureText = 14.5;  // before a figure is scaled down to the columns of a
                                           // paper
constexpr double kOneColumn = 336.0;       // 3.5 inches
constexpr double kTwoColumns = 687.0;      // 7.16 inches
constexpr double kSwatchGap = 8.0;         // between a legend's sign and its name
constexpr double kEntryGap = 18.0;         // between entries of the legend
// Average width of a letter, in small print and in the legend.
constexpr double kNoteLetter = 6.15;
constexpr double kNameLetter = 6.9;

constexpr std::string_view kFontFamily = "'Liberation Sans',Arial,Helvetica,sans-serif";

// Plain colours, those of the page's light theme, since few programs other than browsers support
// CSS variables.
constexpr std::string_view kStyle =
    "text{fill:#16202a}"
    "text.title{font-size:15px;font-weight:600}text.note,text.label{fill:#55636f}"
    "text.note{font-size:11.5px}text.middle{text-anchor:middle}text.end{text-anchor:end}"
    ".line,.rule,.axis,.grid-line,.points{fill:none}"
    ".line{stroke-width:1.9;stroke-linejoin:round;stroke-linecap:round}"
    ".points{stroke-width:7;stroke-linecap:round}"
    ".dash{stroke-dasharray:7 5;stroke-linecap:butt}"
    ".rule{stroke:#16202a;stroke-width:1.4;stroke-dasharray:2 3}"
    ".way,.outline,.dots,.mark,.arrow,.frame{fill:none}"
    ".axis,.frame{stroke:#55636f;stroke-width:1}.grid-line{stroke:#e6ebef;stroke-width:1}"
    ".c0{stroke:#0072b2}.c1{stroke:#d98200}.c2{stroke:#009e73}.c3{stroke:#b8568f}"
    ".c4{stroke:#d55e00}.c5{stroke:#3a9bd1}.c6{stroke:#16202a}.c7{stroke:#55636f}"
    ".c8{stroke:#0d0887}.c9{stroke:#fcbe2c}"
    ".c10{stroke:#3b4cc0}.c11{stroke:#21918c}.c12{stroke:#5aae3c}.c13{stroke:#e6a117}"
    ".c14{stroke:#c21807}"
    ".unsafe{fill:#c9d0d7}.free{fill:#ffffff}.obstacle{fill:#8b97a2}"
    ".partial{fill:#8b97a2;fill-opacity:.3;stroke:#8b97a2;stroke-dasharray:5 4}"
    ".area{fill:#d55e00;fill-opacity:.1}"
    ".target{fill:#009e73;fill-opacity:.18;stroke:#009e73;stroke-width:2}"
    ".way{stroke-width:2.2;stroke-linejoin:round;stroke-linecap:round}"
    ".faint{stroke-width:1.1;stroke-opacity:.45}"
    ".broken{stroke-width:1.3;stroke-dasharray:4 3;stroke-linecap:butt}"
    ".arrow{stroke-width:2.2;stroke-linejoin:miter}"
    ".outline{stroke-width:1.6;stroke-linejoin:round;stroke-linecap:round}"
    ".thin{stroke-width:.9}"
    ".spot{stroke-width:4}.dots{stroke-linecap:round;stroke-opacity:.6}"
    ".mark{stroke-width:9;stroke-linecap:round}.square{stroke-linecap:square}"
    ".mark.edge{stroke:#ffffff;stroke-width:12}"
    "text.time{font-size:12px;font-weight:600}"
    "text.edge{stroke:#ffffff;stroke-width:3px;stroke-linejoin:round}";

/// Style of moving obstacles, which few figures have.
constexpr std::string_view kMoverStyle = ".mover{fill:#0072b2;fill-opacity:.3;stroke-width:.9}";

/// What differs between a chart and a map.
struct Part {
  std::string title;
  std::string note;
  std::vector<LegendEntry> legend;
  double width = 0.0;  ///< of the drawing
  double height = 0.0;
  bool is_empty = false;
};

Part part_of(const Chart& chart) {
  return {.title = chart.title,
          .note = chart.note,
          .legend = chart_legend(chart),
          .width = kChartWidth,
          .height = kChartHeight,
          .is_empty = !has_points(chart)};
}

Part part_of(const PlaneMap& map) {
  const MapSize size = map_size(map);
  return {.title = map.title,
          .note = map_note(map),
          .legend = map_legend(map),
          .width = size.width,
          .height = size.height,
          .is_empty = !has_content(map)};
}

std::string drawing_of(const Chart& chart, double x, double y) {
  return chart_drawing(chart, x, y);
}
std::string drawing_of(const PlaneMap& map, double x, double y) { return map_drawing(map, x, y); }

std::string text_at(std::string_view classes, double x, double y, const std::string& text) {
  return fmt::format("<text class=\"{}\" x=\"{:.1f}\" y=\"{:.1f}\">{}</text>\n", classes, x, y,
                     escape_html(text));
}

/// A block of SVG, such as the texts above a drawing, and its height.
struct Head {
  std::string svg;
  double height = 0.0;
};

std::size_t letters_in(double width, double letter) {
  return static_cast<std::size_t>(width / letter);
}

double text_size(const FigureStyle& style) {
  return style.columns == 0 ? kFigureText : kSmallFigureText;
}

/// Entries side by side while they fit `width`; a long name takes several lines.
Head legend_svg(const std::vector<LegendEntry>& entries, double width, double letters) {
  const std::size_t columns =
      letters_in(width - kSwatchWidth - kSwatchGap, kNameLetter * letters / kFigureText);
  Head legend;
  double x = 0.0;
  double y = 0.0;  // of the line's lower edge
  for (const LegendEntry& entry : entries) {
    const std::vector<std::string> lines = wrapped(entry.name, columns);
    double needed = 0.0;
    for (const std::string& line : lines) {
      needed = std::max(needed, estimated_width(line, letters));
    }
    needed += kSwatchWidth + kSwatchGap;
    if (y == 0.0 || x + needed > width) {
      x = 0.0;
      y = legend.height + kLineHeight;
    }
    legend.svg += fmt::format("<g transform=\"translate({:.1f} {:.1f})\">{}</g>", x,
                              y - 4.0 - kSwatchHeight / 2.0, entry.drawing);
    double foot = y;
    for (const std::string& line : lines) {
      legend.svg += text_at("", x + kSwatchWidth + kSwatchGap, foot, line);
      foot += kLineHeight;
    }
    legend.height = std::max({legend.height, y, foot - kLineHeight});
    x += needed + kEntryGap;
  }
  return legend;
}

/// Relative to (0, 0), its top left corner.
Head head_of(const Part& part, const FigureStyle& style) {
  Head head;
  double y = part.title.empty() ? 0.0 : kTitleHeight - 10.0;
  if (!part.title.empty()) head.svg = text_at("title", 0.0, y, part.title);
  for (const std::string& line : wrapped(part.note, letters_in(part.width, kNoteLetter))) {
    y += kLineHeight;
    head.svg += text_at("note", 0.0, y, line);
  }
  const Head legend = legend_svg(part.legend, part.width, text_size(style));
  head.svg += fmt::format("<g transform=\"translate(0 {:.1f})\">{}</g>\n", y, legend.svg);
  head.height = y + legend.height + 10.0;
  return head;
}

std::string panel_svg(const Panel& panel, const Part& part, const FigureStyle& style,
                      MapPoint corner, double head_height) {
  std::string svg = fmt::format("<g transform=\"translate({:.1f} {:.1f})\">{}</g>\n", corner.x,
                                corner.y, head_of(part, style).svg);
  const double y = corner.y + head_height;
  if (part.is_empty) {
    return svg + text_at("note", corner.x, y + kTitleHeight, "No finite values to draw.");
  }
  return svg + std::visit([&](const auto& own) { return drawing_of(own, corner.x, y); }, panel);
}

/// Where each column begins, and where the last one ends, including a margin.
std::vector<double> columns_of(const std::vector<Part>& parts, const FigureStyle& style) {
  std::vector<double> columns = {kMargin};
  const std::size_t in_row = std::min(parts.size(), style.columns == 1 ? 1 : kPanelsInRow);
  for (std::size_t column = 0; column < in_row; ++column) {
    double width = 0.0;
    for (std::size_t n = column; n < parts.size(); n += in_row) {
      width = std::max(width, parts[n].width);
    }
    columns.push_back(columns.back() + width + kMargin);
  }
  return columns;
}

/// The document of `width` x `height` units with `in_row` panels side by side, scaled to the width
/// that `style` asks for.
std::string document(double width, double height, std::size_t in_row, const FigureStyle& style,
                     const std::string& body) {
  // A single panel keeps the font size of panels side by side: it takes half of two columns.
  const bool is_narrow = style.columns == 1 || in_row == 1;
  const double shown = style.columns == 0 ? width : is_narrow ? kOneColumn : kTwoColumns;
  return fmt::format(
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0:.0f}\" height=\"{1:.0f}\" "
      "viewBox=\"0 0 {2:.0f} {3:.0f}\">\n<style>text{{font:{4}px {5}}}{6}{7}</style>\n"
      "<rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>\n{8}</svg>\n",
      shown, height * shown / width, width, height, text_size(style), kFontFamily, kStyle,
      body.find("class=\"mover") == std::string::npos ? "" : kMoverStyle, body);
}

}  // namespace

std::string panel_letter(std::size_t panel, std::size_t count) {
  constexpr std::size_t kLetters = 26;
  if (count < 2) return {};
  return panel < kLetters ? fmt::format("({})", static_cast<char>('a' + panel))
                          : fmt::format("({})", panel + 1);
}

std::string svg_figure(const std::vector<Panel>& panels, const FigureStyle& style) {
  std::vector<Part> parts;
  parts.reserve(panels.size());
  for (const Panel& panel : panels) {
    Part part = std::visit([](const auto& own) { return part_of(own); }, panel);
    if (!style.titles) {
      part.title = panel_letter(parts.size(), panels.size());
      part.note.clear();
    }
    parts.push_back(std::move(part));
  }
  const std::vector<double> columns = columns_of(parts, style);
  const std::size_t in_row = std::max<std::size_t>(1, columns.size() - 1);
  std::string body;
  double y = kMargin;
  for (std::size_t first = 0; first < panels.size(); first += in_row) {
    const std::size_t end = std::min(first + in_row, panels.size());
    double head = 0.0;
    double drawing = 0.0;
    for (std::size_t n = first; n < end; ++n) {
      head = std::max(head, head_of(parts[n], style).height);
      drawing = std::max(drawing, parts[n].height);
    }
    for (std::size_t n = first; n < end; ++n) {
      body += panel_svg(panels[n], parts[n], style, {.x = columns[n - first], .y = y}, head);
    }
    y += head + drawing + (end < panels.size() ? kGap : 0.0);
  }
  return document(columns.back(), y + kMargin, in_row, style, body);
}

std::string panel_figure(const Panel& panel) {
  const Chart* chart = std::get_if<Chart>(&panel);
  return chart != nullptr ? chart_figure(*chart) : map_figure(std::get<PlaneMap>(panel));
}

}  // namespace qsmpc::harness
