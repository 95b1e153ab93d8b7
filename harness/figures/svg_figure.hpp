// Charts and maps as an SVG file of its own: with titles, legends and a style that any viewer
// draws.
//
//   write_file(folder + "/w2.svg", svg_figure({chart, map}));
#pragma once

#include <concepts>
#include <string>
#include <variant>
#include <vector>

#include "harness/figures/plane_map.hpp"
#include "harness/figures/svg_chart.hpp"

namespace qsmpc::harness {

using Panel = std::variant<Chart, PlaneMap>;

/// The panels side by side, two in a row, as one SVG document in UTF-8 on a white ground. It refers
/// to nothing outside of itself. A panel without finite values says so.
[[nodiscard]] std::string svg_figure(const std::vector<Panel>& panels);

/// The same of a list of charts or of maps alone. A template, so that svg_figure({chart, map})
/// means the one above.
template <class Drawing>
requires std::same_as<Drawing, Chart> || std::same_as<Drawing, PlaneMap>
[[nodiscard]] std::string svg_figure(const std::vector<Drawing>& drawings) {
  return svg_figure(std::vector<Panel>(drawings.begin(), drawings.end()));
}

/// A panel as a <figure> of a page.
[[nodiscard]] std::string panel_figure(const Panel& panel);

}  // namespace qsmpc::harness
