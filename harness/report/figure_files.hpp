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

/// Where figures stand within a folder.
inline constexpr const char* kFigureFolder = "figures";

/// Panels that stand together.
struct FigureFile {
  std::string name;  ///< of its files, without what follows the dot
  std::vector<Panel> panels;
};

/// "map", of a system with a position in the plane, and each chart along the drive, named by the
/// first words of its title: "certificates", "clearance", "input-yaw-rate",
/// "solve-time", "expected-cost", "error-budget", …
[[nodiscard]] std::vector<FigureFile> episode_figures(const EpisodeView& view);

/// "residuals", "divergence", "w2", "certificates".
[[nodiscard]] std::vector<FigureFile> figures_of(const Comparison& comparison);

/// "reliability", "outcomes", "map" of the drives where the store has their paths, "distributions"
/// where they differ, "differences" where variants are compared.
[[nodiscard]] std::vector<FigureFile> figures_of(const CampaignStatistics& statistics);

/// Writes each as SVG and PDF, set in `style`, into `folder`/figures, which is made if need be, and
/// captions.txt: the titles and notes of all panels. None has its name before all are written.
/// Returns their paths. Throws IoError.
std::vector<std::string> write_figures(const std::vector<FigureFile>& figures,
                                       const std::string& folder, const FigureStyle& style = {});

/// The name of a figure with the title `title`: its first words, up to a colon, a comma, a bracket,
/// "at", "of" or "against" (of "Input: …", all of it), in lower case, with a hyphen for all that is
/// no letter or digit.
[[nodiscard]] std::string figure_name(const std::string& title);

}  // namespace qsmpc::harness
