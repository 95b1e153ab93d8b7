// What the parts of the Python module share: each adds its classes and functions to the module.
#pragma once

#include <nanobind/nanobind.h>

namespace qsmpc::python {

void add_errors(nanobind::module_& module);
void add_scenarios(nanobind::module_& module);
void add_controllers(nanobind::module_& module);
void add_episodes(nanobind::module_& module);
void add_drives(nanobind::module_& module);
void add_planning(nanobind::module_& module);
void add_predictions(nanobind::module_& module);
void add_comparisons(nanobind::module_& module);
void add_campaigns(nanobind::module_& module);

}  // namespace qsmpc::python
