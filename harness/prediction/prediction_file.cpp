#include "harness/prediction/prediction_file.hpp"

#include <cstddef>
#include <utility>

#include "harness/errors.hpp"
#include "harness/files/file_group.hpp"
#include "harness/prediction/prediction_json.hpp"
#include "harness/scenario/scenario_file.hpp"
#include "harness/trace/certificate_datasets.hpp"
#include "harness/trace/coordinate_labels.hpp"
#include "harness/trace/cost_fields.hpp"
#include "harness/trace/file_header.hpp"
#include "harness/trace/rows.hpp"

namespace qsmpc::harness {
namespace {

using Layout = std::vector<DatasetSpec>;
using Type = DatasetSpec::Type;

constexpr const char* kRateMeaning =
    "share of the simulated paths that are unsafe, and its Clopper-Pearson limits, each of "
    "confidence 1 - 1e-6";

/// Names, units and numbers of states and inputs.
struct Labels {
  CoordinateLabels states;
  CoordinateLabels inputs;
  [[nodiscard]] std::size_t state_dim() const { return states.names.size(); }
  [[nodiscard]] std::size_t input_dim() const { return inputs.names.size(); }
};

void add_plan(Layout& layout, const Labels& n) {
  layout.push_back({.path = "/belief/mean",
                    .axes = {"state"},
                    .units = n.states.units,
                    .columns = n.states.names,
                    .comment = "of the Gaussian that the plan is made for",
                    .chunk_rows = n.state_dim()});
  layout.push_back({.path = "/belief/covariance",
                    .row_shape = {n.state_dim()},
                    .axes = {"state", "state"},
                    .units = n.states.units,
                    .columns = n.states.names,
                    .comment = "an entry has the unit of its row times that of its column",
                    .chunk_rows = n.state_dim()});
  layout.push_back({.path = "/plan/time",
                    .axes = {"stage"},
                    .units = {"s"},
                    .comment = "of the stage; stage 0 is the present"});
  layout.push_back({.path = "/plan/inputs",
                    .row_shape = {n.input_dim()},
                    .axes = {"stage", "input"},
                    .units = n.inputs.units,
                    .columns = n.inputs.names,
                    .comment = "nominal inputs v of the policy u(x) = clamp(v + K (x - nominal))"});
  layout.push_back({.path = "/plan/states",
                    .row_shape = {n.state_dim()},
                    .axes = {"stage", "state"},
                    .units = n.states.units,
                    .columns = n.states.names,
                    .comment = "nominal states: under the nominal inputs, without noise"});
  layout.push_back({.path = "/plan/gains",
                    .row_shape = {n.input_dim(), n.state_dim()},
                    .axes = {"stage", "input", "state"},
                    .units = {"unit of the input per unit of the state"},
                    .comment = "K; zero for an open-loop policy"});
  layout.push_back({.path = "/plan/cost",
                    .axes = {"part"},
                    .units = {"1"},
                    .columns = cost_part_names(),
                    .comment = "expected cost by part"});
}

void add_particles(Layout& layout, const Labels& n) {
  const std::string slices =
      "the points of stage s are the rows from offsets[s] up to but not including offsets[s + 1], "
      "counted from 0; stage 0 is the quantised belief";
  layout.push_back({.path = "/particles/locations",
                    .row_shape = {n.state_dim()},
                    .axes = {"point", "state"},
                    .units = n.states.units,
                    .columns = n.states.names,
                    .comment = slices,
                    .compress = true});
  layout.push_back({.path = "/particles/weights",
                    .axes = {"point"},
                    .units = {"1"},
                    .comment = slices,
                    .compress = true});
  layout.push_back({.path = "/particles/offsets",
                    .type = Type::kInt64,
                    .axes = {"stage"},
                    .units = {"row of locations and weights"},
                    .comment = slices});
  layout.push_back({.path = "/particles/stepped",
                    .row_shape = {n.state_dim()},
                    .axes = {"point", "state"},
                    .units = n.states.units,
                    .columns = n.states.names,
                    .comment = "where the dynamics take the point of the same row, before noise "
                               "and compression; none for the last stage",
                    .compress = true});
  layout.push_back({.path = "/particles/mean",
                    .row_shape = {n.state_dim()},
                    .axes = {"stage", "state"},
                    .units = n.states.units,
                    .columns = n.states.names});
  layout.push_back(
      {.path = "/particles/covariance",
       .row_shape = {n.state_dim(), n.state_dim()},
       .axes = {"stage", "state", "state"},
       .units = n.states.units,
       .columns = n.states.names,
       .comment = "of the points, without what quantisation and compression left out"});
}

void add_certificate(Layout& layout) {
  for (DatasetSpec& spec : certificate_layout()) layout.push_back(std::move(spec));
  layout.push_back({.path = "/certificate/horizon",
                    .axes = {"plan"},
                    .units = {"1"},
                    .comment = "upper bound of the probability of being unsafe at any stage",
                    .chunk_rows = 1});
}

void add_monte_carlo(Layout& layout) {
  layout.push_back({.path = "/monte_carlo/unsafe",
                    .type = Type::kInt64,
                    .axes = {"stage"},
                    .units = {"paths"},
                    .comment = "how many are unsafe at the stage; the first is stage 1"});
  layout.push_back({.path = "/monte_carlo/rate",
                    .row_shape = {3},
                    .axes = {"stage", "limit"},
                    .units = {"1"},
                    .columns = {"rate", "lower", "upper"},
                    .comment = kRateMeaning});
  layout.push_back({.path = "/monte_carlo/any_stage",
                    .row_shape = {3},
                    .axes = {"plan", "limit"},
                    .units = {"1"},
                    .columns = {"rate", "lower", "upper"},
                    .comment = "the same for being unsafe at any stage",
                    .chunk_rows = 1});
}

void write_header(Hdf5File& file, const PredictionReport& report) {
  write_file_header(file, {.kind = "prediction",
                           .schema = kPredictionSchema,
                           .version = report.version,
                           .scenario_text = report.scenario_text,
                           .scenario_name = report.scenario.name,
                           .seed = report.scenario.seed});
  file.set_text("/", "inputs", report.inputs_given ? "given" : "planned");
  file.set_text("/", "solver_status", report.solver_status);
}

void write_plan(Hdf5File& file, const PredictionReport& report) {
  const controller::Policy& policy = report.policy;
  file.append("/belief/mean", by_rows(report.scenario.initial_state.mean));
  file.append("/belief/covariance", by_rows(report.scenario.initial_state.covariance));
  std::vector<double> times;
  for (Eigen::Index k = 0; k <= policy.horizon(); ++k) {
    times.push_back(static_cast<double>(k) * report.scenario.time_step);
  }
  file.append("/plan/time", times);
  // A stage is a column in memory and a row in the file.
  file.append("/plan/inputs", by_rows(policy.inputs.transpose()));
  file.append("/plan/states", by_rows(policy.states.transpose()));
  std::vector<double> gains;
  for (const Eigen::MatrixXd& gain : policy.gains) append_to(gains, by_rows(gain));
  file.append("/plan/gains", gains);
  file.append("/plan/cost", cost_row(report.cost));
}

void write_particles(Hdf5File& file, const controller::Prediction& prediction) {
  std::vector<std::int64_t> offsets = {0};
  for (const controller::DiscreteMeasure& stage : prediction.stages) {
    file.append("/particles/locations", by_rows(stage.locations.transpose()));
    file.append("/particles/weights", by_rows(stage.weights));
    file.append("/particles/mean", by_rows(controller::mean_of(stage)));
    file.append("/particles/covariance", by_rows(controller::covariance_of(stage)));
    offsets.push_back(offsets.back() + stage.size());
  }
  file.append("/particles/offsets", offsets);
  for (const controller::Points& stepped : prediction.stepped) {
    file.append("/particles/stepped", by_rows(stepped.transpose()));
  }
}

void write_certificate(Hdf5File& file, const PredictionReport& report) {
  append_certificates(file, report.budgets, report.certificates);
  file.append("/certificate/horizon", std::vector<double>{report.horizon_bound});
}

void write_monte_carlo(Hdf5File& file, const UnsafeCounts& counts) {
  const auto append_rate = [&](const char* path, std::int64_t events) {
    const SimulatedRate simulated = simulated_rate(events, counts.samples);
    file.append(
        path, std::vector<double>{simulated.rate, simulated.limits.lower, simulated.limits.upper});
  };
  file.set_integer("/monte_carlo", "samples", counts.samples);
  file.append("/monte_carlo/unsafe", counts.stages);
  for (const std::int64_t events : counts.stages) append_rate("/monte_carlo/rate", events);
  append_rate("/monte_carlo/any_stage", counts.any_stage);
}

void write_hdf5(const PredictionReport& report, const std::string& path) {
  Hdf5File file = Hdf5File::create(path);
  write_header(file, report);
  for (const DatasetSpec& spec : prediction_layout(report)) file.create_dataset(spec);
  write_plan(file, report);
  write_particles(file, report.prediction);
  write_certificate(file, report);
  if (report.monte_carlo) write_monte_carlo(file, *report.monte_carlo);
  file.close();
}

}  // namespace

std::vector<DatasetSpec> prediction_layout(const PredictionReport& report) {
  const Labels labels{.states = labels_of(report.system.states),
                      .inputs = labels_of(report.system.inputs)};
  Layout layout;
  add_plan(layout, labels);
  add_particles(layout, labels);
  add_certificate(layout);
  if (report.monte_carlo) add_monte_carlo(layout);
  return layout;
}

void write_prediction(const PredictionReport& report, const std::string& folder) {
  FileGroup files;
  const PendingFile& measures = files.add(folder + "/" + kPredictionFile);
  files.add(folder + "/" + kScenarioFile).write(report.scenario_text);
  files.add(folder + "/" + kPredictionNumbersFile).write(prediction_json(report));
  write_hdf5(report, measures.partial_path());
  // Ensures that an older predict.json never stands beside a new predict.h5.
  files.commit_sealed();
}

}  // namespace qsmpc::harness
