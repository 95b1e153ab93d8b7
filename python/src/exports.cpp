// Data for the files of other viewers, besides an episode's arrays.
#include <optional>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

#include "python/src/arrays.hpp"
#include "python/src/calls.hpp"
#include "python/src/episodes.hpp"
#include "python/src/module.hpp"
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include "controller/regions/body_outline.hpp"
#include "harness/files/atomic_file.hpp"
#include "harness/trace/map_axes.hpp"
#include "render/colour.hpp"

namespace qsmpc::python {
namespace {

namespace nb = nanobind;
using nb::literals::operator""_a;

/// The states that a map shows, and whether they are the position in the plane.
std::optional<std::tuple<int, int, bool>> axes_of(const Episode& episode) {
  const std::optional<harness::MapAxes> axes = harness::map_axes(episode.view().system());
  if (!axes) return std::nullopt;
  return std::tuple(axes->x, axes->y, axes->is_plane);
}

/// The body's outline, arcs x 5: centre, radius (m), from, to (rad), in the vehicle's frame.
RowMatrix outline_of(const harness::Scenario& scenario) {
  const auto arcs = controller::body_outline(scenario.safe_set.body, Eigen::Vector2d::Zero(), 0.0);
  RowMatrix rows(std::ssize(arcs), 5);
  for (Eigen::Index k = 0; k < rows.rows(); ++k) {
    const controller::Arc& arc = arcs[static_cast<std::size_t>(k)];
    rows.row(k) << arc.centre.x(), arc.centre.y(), arc.radius, arc.from, arc.to;
  }
  return rows;
}

void write(const std::string& path, const nb::bytes& content) {
  const std::string_view bytes(content.c_str(), content.size());
  without_lock([&] { harness::write_file(path, bytes); });
}

}  // namespace

void add_exports(nb::module_& module) {
  module.def(
      "coordinates",
      [](const Episode& e) {
        return std::pair(units_of(e.view().system().states), units_of(e.view().system().inputs));
      },
      "episode"_a, "Name and unit of each state and of each input.");
  module.def(
      "heading", [](const Episode& e) { return e.view().system().heading; }, "episode"_a,
      "Index of the state that is the heading; -1 if there is none.");
  module.def("map_axes", &axes_of, "episode"_a,
             "The states that a map shows, and whether they are the position in the plane.");
  module.def(
      "clearance_unit", [](const Episode& e) { return e.view().clearance_unit(); }, "episode"_a);
  module.def(
      "stage_colour",
      [](int stage, int stages) {
        const render::Colour colour = render::stage_colour(stage, stages);
        return std::tuple(colour.red, colour.green, colour.blue, colour.alpha);
      },
      "stage"_a, "stages"_a, "As videos colour it: red, green, blue, opacity, 0 ... 1.");
  module.def("body_outline", &outline_of, "scenario"_a,
             "The arcs about the vehicle, in its frame: centre, radius, from, to; arcs x 5.");
  module.def("write_file", &write, "path"_a, "content"_a,
             "Writes a file completely or not at all.");
}

}  // namespace qsmpc::python
