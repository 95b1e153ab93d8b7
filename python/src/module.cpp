// The extension module `qsmpc._native.core`, on which the package's Python code is built. Arrays
// have samples as rows; the library's matrices have them as columns.
#include "python/src/module.hpp"

#include "harness/version.hpp"

NB_MODULE(core, module) {
  using namespace qsmpc::python;
  module.doc() = "The library behind the package qsmpc. Use the package instead.";
  module.attr("__version__") = qsmpc::kVersion;
  add_errors(module);
  add_scenarios(module);
  add_controllers(module);
  add_episodes(module);
  add_exports(module);
  add_drives(module);
  add_planning(module);
  add_predictions(module);
  add_comparisons(module);
  add_campaigns(module);
}
