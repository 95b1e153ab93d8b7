// The one place that talks to librsvg and cairo: an SVG figure as PDF, for papers.
//
//   write_file("w2.pdf", pdf_figure(svg_figure(charts), "W2 by stage"));
#pragma once

#include <string>

namespace qsmpc::harness {

/// `svg`, a document that says its width and height, as a PDF of one page of that size (96 units an
/// inch), drawn as vectors, with the letters that it uses embedded. `title` is in its properties.
/// The same input gives the same bytes on one machine: no date is in it. Throws
/// std::invalid_argument where `svg` is none, std::runtime_error where it cannot be drawn.
[[nodiscard]] std::string pdf_figure(const std::string& svg, const std::string& title);

}  // namespace qsmpc::harness
