// Charts and maps as an SVG file of its own: with titles, legends and a style that any viewer
// draws.
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

/// How a figure is set.
struct FigureStyle {
  bool titles = true;  ///< title and note above each panel; else "(a)", "(b)", … above several
  /// Of a paper, that the figure is as wide as, with letters of about 7 points: 1 (3.5 inches, one
  /// panel in a row) or 2 (7.16 inches, two in a row); 0: as wide as two panels need, 9 points.
  int columns = 0;
};

/// "(a)" of the first of `count` panels; nothing of a single one.
[[nodiscard]] std::string panel_letter(std::size_t panel, std::size_t count);

/// The panels side by side, two in a row, as one SVG document in UTF-8 on a white ground. It refers
/// to nothing outside of itself. A panel without finite values says so.
[[nodiscard]] std::string svg_figure(const std::vector<Panel>& panels,
                                     const FigureStyle& style = {});

/// The same of a list of charts or of maps alone. A template, so that svg_figure({chart, map})
/// means the one above.
template <class Drawing>
requires std::same_as<Drawing, Chart> || std::same_as<Drawing, PlaneMap>
[[nodiscard]] std::string svg_figure(const std::vector<Drawing>& drawings) {
  return svg_figure(std::vector<Panel>(drawings.begin(), drawings.end()), FigureStyle{});
}

/// A panel as a <figure> of a page.
[[nodiscard]] std::string panel_figure(const Panel& panel);

}  // namespace qsmpc::harness
