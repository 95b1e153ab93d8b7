// The results of `qsmpc predict`.
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "python/src/arrays.hpp"
#include "python/src/calls.hpp"
#include "python/src/module.hpp"
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>

#include "harness/files/atomic_file.hpp"
#include "harness/prediction/prediction_file.hpp"
#include "harness/prediction/prediction_json.hpp"
#include "harness/prediction/prediction_report.hpp"
#include "harness/prediction/prediction_table.hpp"
#include "harness/threads/interruption.hpp"

namespace qsmpc::python {
namespace {

namespace nb = nanobind;
using nb::literals::operator""_a;
using harness::PredictionReport;
using harness::Scenario;

PredictionReport predict(Scenario scenario, const std::optional<RowMatrix>& inputs,
                         std::int64_t monte_carlo) {
  if (monte_carlo < 0) throw nb::value_error("monte_carlo must be at least 0");
  harness::PredictionOptions options;
  if (inputs) {
    options.inputs = as_columns(*inputs);
    scenario.controller.horizon = static_cast<int>(inputs->rows());
  }
  refuse_beyond_memory(scenario);
  options.monte_carlo = {.samples = monte_carlo,
                         .should_stop = [] { return harness::interrupts() > 0; }};
  return without_lock([&] { return harness::predict_scenario(scenario, options); });
}

std::pair<RowMatrix, Eigen::VectorXd> particles_of(const PredictionReport& report,
                                                   std::size_t stage) {
  const auto& stages = report.prediction.stages;
  if (stage >= stages.size()) throw nb::index_error("no such stage");
  return {as_rows(stages[stage].locations), stages[stage].weights};
}

}  // namespace

void add_predictions(nb::module_& module) {
  nb::class_<PredictionReport>(module, "Prediction")
      .def_prop_ro("scenario", [](const PredictionReport& r) { return r.scenario; })
      .def_prop_ro("inputs", [](const PredictionReport& r) { return as_rows(r.policy.inputs); })
      .def_prop_ro("states", [](const PredictionReport& r) { return as_rows(r.policy.states); })
      .def_ro("horizon_bound", &PredictionReport::horizon_bound)
      .def("particles", &particles_of, "stage"_a)
      .def("to_json", &harness::prediction_json)
      .def("table", &harness::prediction_table)
      .def(
          "save",
          [](const PredictionReport& report, const std::string& folder) {
            without_lock([&] {
              harness::make_output_folder(folder);
              harness::write_prediction(report, folder);
            });
          },
          "folder"_a);
  module.def("predict", &predict, "scenario"_a, "inputs"_a.none(), "monte_carlo"_a);
}

}  // namespace qsmpc::python
