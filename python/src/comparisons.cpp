// The results of `qsmpc compare`.
#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "python/src/arrays.hpp"
#include "python/src/calls.hpp"
#include "python/src/module.hpp"
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include "harness/cli/artefacts.hpp"
#include "harness/figures/svg_figure.hpp"
#include "harness/files/atomic_file.hpp"
#include "harness/mismatch/comparison.hpp"
#include "harness/mismatch/comparison_file.hpp"
#include "harness/mismatch/comparison_json.hpp"
#include "harness/mismatch/comparison_table.hpp"
#include "harness/report/comparison_charts.hpp"
#include "harness/report/comparison_page.hpp"
#include "harness/threads/interruption.hpp"
#include "harness/threads/workers.hpp"

namespace qsmpc::python {
namespace {

namespace nb = nanobind;
using nb::literals::operator""_a;
using harness::Comparison;

Comparison compare(const harness::Scenario& scenario, const std::vector<std::string>& plants,
                   int episodes, std::int64_t paths, int threads) {
  if (episodes < 1 || paths < 1) throw nb::value_error("episodes and paths must be at least 1");
  refuse_beyond_memory(scenario, std::min(harness::usable_threads(threads), episodes));
  return without_lock([&] {
    std::optional<Comparison> comparison = harness::compare_plants(
        scenario, {.plants = plants,
                   .episodes = episodes,
                   .paths = paths,
                   .threads = threads,
                   .should_stop = [] { return harness::interrupts() > 0; }});
    if (!comparison) throw harness::Interrupted();
    return *std::move(comparison);
  });
}

/// Writes the files of `qsmpc compare`.
void save(const Comparison& comparison, const std::string& folder) {
  without_lock([&] {
    harness::make_output_folder(folder);
    std::vector<harness::TextFile> files;
    for (const harness::ComparisonFigure& figure : harness::comparison_figures(comparison)) {
      files.push_back(
          {.path = folder + "/" + figure.file, .text = harness::svg_figure(figure.charts)});
    }
    files.push_back(
        {.path = folder + "/" + harness::kPageFile, .text = harness::comparison_page(comparison)});
    harness::write_comparison(comparison, files, folder);
  });
}

const harness::PlantComparison& plant_of(const Comparison& comparison, const std::string& name) {
  for (const harness::PlantComparison& plant : comparison.plants) {
    if (plant.name == name) return plant;
  }
  throw nb::key_error(name.c_str());
}

/// Rows: the one-step residuals of all periods of a plant's episodes.
RowMatrix residuals_of(const Comparison& comparison, const std::string& name) {
  const harness::PlantComparison& plant = plant_of(comparison, name);
  Eigen::Index count = 0;
  for (const harness::EpisodeResult& episode : plant.episodes) count += episode.residuals.cols();
  RowMatrix rows(count, std::ssize(comparison.system.states));
  Eigen::Index at = 0;
  for (const harness::EpisodeResult& episode : plant.episodes) {
    rows.middleRows(at, episode.residuals.cols()) = episode.residuals.transpose();
    at += episode.residuals.cols();
  }
  return rows;
}

}  // namespace

void add_comparisons(nb::module_& module) {
  nb::class_<Comparison>(module, "Comparison")
      .def_prop_ro("scenario", [](const Comparison& c) { return c.scenario; })
      .def_prop_ro("plants",
                   [](const Comparison& c) {
                     std::vector<std::string> names;
                     for (const auto& plant : c.plants) names.push_back(plant.name);
                     return names;
                   })
      .def("residuals", &residuals_of, "plant"_a)
      .def("to_json", &harness::comparison_json)
      .def("table", &harness::comparison_table)
      .def("save", &save, "folder"_a);
  module.def("compare", &compare, "scenario"_a, "plants"_a, "episodes"_a, "paths"_a, "threads"_a);
}

}  // namespace qsmpc::python
