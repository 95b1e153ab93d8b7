#include "harness/figures/legend.hpp"

#include <fmt/format.h>

#include "harness/text/html.hpp"

namespace qsmpc::harness {

LegendEntry line_entry(const std::string& classes, const std::string& name) {
  return {.drawing = "<path class=\"" + classes + "\" d=\"M2 6H26\"/>", .name = name};
}

LegendEntry dot_entry(const std::string& classes, const std::string& name) {
  return {.drawing = "<path class=\"" + classes + "\" d=\"M14 6h0\"/>", .name = name};
}

LegendEntry area_entry(const std::string& classes, const std::string& name) {
  return {.drawing = "<rect class=\"" + classes + "\" x=\"6\" y=\"1\" width=\"16\" height=\"10\"/>",
          .name = name};
}

std::string legend_html(const std::vector<LegendEntry>& entries) {
  std::string items;
  for (const LegendEntry& entry : entries) {
    items += fmt::format(
        "<li><svg class=\"swatch\" viewBox=\"0 0 {} {}\" aria-hidden=\"true\">{}</svg>{}</li>",
        kSwatchWidth, kSwatchHeight, entry.drawing, escape_html(entry.name));
  }
  return "<ul class=\"legend\">" + items + "</ul>\n";
}

}  // namespace qsmpc::harness
