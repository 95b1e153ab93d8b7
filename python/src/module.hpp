// The parts of the Python module: each adds its classes and functions to the module.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include <nanobind/nanobind.h>

#include "models/dynamics/dynamics.hpp"

namespace qsmpc::python {

/// Names, each with a description.
using Described = std::vector<std::pair<std::string, std::string>>;

/// Name and unit of each.
[[nodiscard]] Described units_of(const std::vector<models::Coordinate>& coordinates);

void add_errors(nanobind::module_& module);
void add_scenarios(nanobind::module_& module);
void add_controllers(nanobind::module_& module);
void add_episodes(nanobind::module_& module);
void add_exports(nanobind::module_& module);
void add_drives(nanobind::module_& module);
void add_planning(nanobind::module_& module);
void add_predictions(nanobind::module_& module);
void add_comparisons(nanobind::module_& module);
void add_campaigns(nanobind::module_& module);

}  // namespace qsmpc::python
