// The only interface to librsvg and cairo: an SVG figure as PDF, for papers.
//
//   write_file("w2.pdf", pdf_figure(svg_figure(charts), "W2 by stage"));
#pragma once

#include <string>

namespace qsmpc::harness {

/// `svg`, a document that states its width and height, as a one-page PDF of that size (96 units per
/// inch) with vector graphics and embedded glyphs. `title` becomes a document property. The PDF
/// contains no date: on one machine the same input gives the same bytes. Throws
/// std::invalid_argument if `svg` is not such a document, and std::runtime_error if it cannot be
/// drawn.
[[nodiscard]] std::string pdf_figure(const std::string& svg, const std::string& title);

}  // namespace qsmpc::harness
