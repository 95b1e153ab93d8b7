#include "harness/report/figure_files.hpp"

#include <algorithm>
#include <cctype>
#include <memory>
#include <optional>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "harness/figures/pdf_figure.hpp"
#include "harness/files/file_group.hpp"
#include "harness/report/campaign_charts.hpp"
#include "harness/report/campaign_drives.hpp"
#include "harness/report/comparison_charts.hpp"
#include "harness/report/episode_charts.hpp"
#include "harness/report/episode_map.hpp"

namespace qsmpc::harness {
namespace {

constexpr std::string_view kInputTitle = "Input: ";

/// Converts figures that already have a file name, e.g. "w2.svg".
template <class Figure>
std::vector<FigureFile> named_by_file(const std::vector<Figure>& figures) {
  std::vector<FigureFile> files;
  files.reserve(figures.size());
  for (const Figure& figure : figures) {
    files.push_back({.name = figure.file.substr(0, figure.file.rfind('.')),
                     .panels = {figure.charts.begin(), figure.charts.end()}});
  }
  return files;
}

/// A figure's name that is still unused.
std::string free_name(const std::vector<FigureFile>& figures, const std::string& name) {
  std::string free = name;
  for (int n = 2; std::ranges::find(figures, free, &FigureFile::name) != figures.end(); ++n) {
    free = fmt::format("{}-{}", name, n);
  }
  return free;
}

/// Length of the part of `title` that says what is drawn; the rest says how.
std::size_t first_words(std::string_view title) {
  std::size_t end = title.size();
  for (const std::string_view rest : {":", ",", " (", " at ", " of ", " against "}) {
    end = std::min(end, title.find(rest));
  }
  return end;
}

std::string title_of(const Panel& panel) {
  return std::visit([](const auto& own) { return own.title; }, panel);
}

std::string note_of(const Panel& panel) {
  const PlaneMap* map = std::get_if<PlaneMap>(&panel);
  return map != nullptr ? map_note(*map) : std::get<Chart>(panel).note;
}

/// One paragraph per figure, with one line per panel.
std::string captions(const std::vector<FigureFile>& figures) {
  std::string text;
  for (const FigureFile& figure : figures) {
    text += (text.empty() ? "" : "\n") + figure.name + "\n";
    for (std::size_t n = 0; n < figure.panels.size(); ++n) {
      const std::string letter = panel_letter(n, figure.panels.size());
      const std::string note = note_of(figure.panels[n]);
      const std::string title = title_of(figure.panels[n]);
      text += fmt::format("  {}{}{}{}{}{}\n", letter, letter.empty() ? "" : " ", title,
                          title.ends_with('?') ? "" : ".", note.empty() ? "" : " ", note);
    }
  }
  return text;
}

}  // namespace

std::string figure_name(const std::string& title) {
  const std::string words =
      title.starts_with(kInputTitle) ? title : title.substr(0, first_words(title));
  std::string name;
  for (const char c : words) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte < 0x80 && std::isalnum(byte) != 0) {
      name += static_cast<char>(std::tolower(byte));
    } else if (!name.empty() && name.back() != '-') {
      name += '-';
    }
  }
  while (name.ends_with('-')) name.pop_back();
  return name.empty() ? "figure" : name;
}

std::vector<FigureFile> episode_figures(const EpisodeView& view) {
  std::vector<FigureFile> figures;
  if (std::optional<EpisodeMaps> maps = episode_maps(view)) {
    figures.push_back({.name = "map", .panels = {std::move(maps->drive)}});
    for (PlaneMap& map : maps->coloured) {
      const std::string name = free_name(figures, figure_name(map.title));
      figures.push_back({.name = name, .panels = {std::move(map)}});
    }
  }
  for (Chart& chart : episode_charts(view)) {
    const std::string name = free_name(figures, figure_name(chart.title));
    figures.push_back({.name = name, .panels = {std::move(chart)}});
  }
  return figures;
}

std::vector<FigureFile> figures_of(const Comparison& comparison) {
  return named_by_file(comparison_figures(comparison));
}

std::vector<FigureFile> figures_of(const CampaignStatistics& statistics) {
  std::vector<FigureFile> figures = named_by_file(campaign_figures(statistics));
  std::vector<PlaneMap> maps = drive_maps(statistics).maps;
  if (!maps.empty()) figures.push_back({.name = "map", .panels = {maps.begin(), maps.end()}});
  return figures;
}

std::vector<std::string> write_figures(const std::vector<FigureFile>& figures,
                                       const std::string& folder, const FigureStyle& style) {
  const std::string target = folder + "/" + kFigureFolder;
  make_output_folder(target);
  FileGroup files;
  for (const FigureFile& figure : figures) {
    const std::string svg = svg_figure(figure.panels, style);
    const std::string title = figure.panels.empty() ? figure.name : title_of(figure.panels.front());
    files.add(target + "/" + figure.name + ".svg").write(svg);
    files.add(target + "/" + figure.name + ".pdf").write(pdf_figure(svg, title));
  }
  files.add(target + "/captions.txt").write(captions(figures));
  files.commit();
  return files.paths();
}

}  // namespace qsmpc::harness
