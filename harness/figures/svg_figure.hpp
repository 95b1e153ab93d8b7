// Charts and maps as a standalone SVG file, with titles, legends and a style that any viewer can
// draw.
//
//   write_file(folder + "/w2.svg", svg_figure({chart, map}));
#pragma once

#include <concepts>
#include <cstddef>
#include <string>
#include <variant>
#include <vector>

#include "harness/figures/plane_map.hpp"
#include "harness/figures/svg_chart.hpp"

namespace qsmpc::harness {

using Panel = std::variant<Chart, PlaneMap>;

/// Layout of a figure.
struct FigureStyle {
  bool titles = true;  ///< title and note above each panel; else "(a)", "(b)", … above several
                       ///< panels
  /// Width of the figure in columns of a paper, with letters of about 7 points: 1 (3.5 inches, one
  /// panel per row) or 2 (7.16 inches, two per row); 0: as wide as two panels need, 9 points.
  int columns = 0;
};

/// "(a)" for the first of `count` panels; empty for a single one.
[[nodiscard]] std::string panel_letter(std::size_t panel, std::size_t count);

/// The panels side by side, two per row, as one self-contained SVG document in UTF-8 on a white
/// background. A panel without finite values says so.
[[nodiscard]] std::string svg_figure(const std::vector<Panel>& panels,
                                     const FigureStyle& style = {});

/// The same for a list of only charts or only maps. A template, so that svg_figure({chart, map})
/// resolves to the overload above.
template <class Drawing>
requires std::same_as<Drawing, Chart> || std::same_as<Drawing, PlaneMap>
[[nodiscard]] std::string svg_figure(const std::vector<Drawing>& drawings) {
  return svg_figure(std::vector<Panel>(drawings.begin(), drawings.end()), FigureStyle{});
}

/// A panel as a <figure> for a page.
[[nodiscard]] std::string panel_figure(const Panel& panel);

}  // namespace qsmpc::harness
