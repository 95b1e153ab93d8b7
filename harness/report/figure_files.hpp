// Figures for papers: the charts and maps of a page as files.
//
//   write_figures(episode_figures(trace), folder);  // FOLDER/figures/map.svg, map.pdf, …
#pragma once

#include <string>
#include <vector>

#include "harness/campaign/statistics/statistics.hpp"
#include "harness/figures/svg_figure.hpp"
#include "harness/mismatch/comparison.hpp"
#include "harness/trace/episode_view.hpp"

namespace qsmpc::harness {

/// The subfolder of the figures.
inline constexpr const char* kFigureFolder = "figures";

/// Panels shown together.
struct FigureFile {
  std::string name;  ///< of its files, without the extension
  std::vector<Panel> panels;
};

/// "map", for a system with a position in the plane, and each chart along the drive, named after
/// the first words of its title: "certificates", "clearance", "input-yaw-rate", "solve-time",
/// "expected-cost", "error-budget", …
[[nodiscard]] std::vector<FigureFile> episode_figures(const EpisodeView& view);

/// "residuals", "divergence", "w2", "certificates".
[[nodiscard]] std::vector<FigureFile> figures_of(const Comparison& comparison);

/// "reliability", "outcomes", "map" of the drives if the store has their paths, "distributions" if
/// they differ, "differences" if variants are compared.
[[nodiscard]] std::vector<FigureFile> figures_of(const CampaignStatistics& statistics);

/// Writes each as SVG and PDF in `style` into `folder`/figures, which is created if necessary,
/// together with captions.txt: the titles and notes of all panels. No file gets its final name
/// before all are written. Returns their paths. Throws IoError.
std::vector<std::string> write_figures(const std::vector<FigureFile>& figures,
                                       const std::string& folder, const FigureStyle& style = {});

/// The name of a figure with the title `title`: its first words, up to a colon, a comma, a bracket,
/// "at", "of" or "against" (for "Input: …", the whole title), in lower case, with hyphens in place
/// of everything but letters and digits.
[[nodiscard]] std::string figure_name(const std::string& title);

}  // namespace qsmpc::harness
