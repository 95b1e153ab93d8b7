#include "harness/mismatch/comparison_file.hpp"

#include <algorithm>
#include <cctype>

#include <fmt/format.h>

#include "harness/errors.hpp"
#include "harness/files/file_group.hpp"
#include "harness/mismatch/comparison_json.hpp"
#include "harness/scenario/scenario_file.hpp"
#include "harness/trace/certificate_fields.hpp"
#include "harness/trace/coordinate_labels.hpp"
#include "harness/trace/file_header.hpp"
#include "harness/trace/rows.hpp"

namespace qsmpc::harness {
namespace {

using Layout = std::vector<DatasetSpec>;
using Type = DatasetSpec::Type;

struct ComparisonSizes {
  CoordinateLabels states;
  CoordinateLabels inputs;
  std::size_t paths = 0;

  [[nodiscard]] std::size_t state_dim() const { return states.names.size(); }
};

ComparisonSizes comparison_sizes(const Comparison& comparison) {
  return {.states = labels_of(comparison.system.states),
          .inputs = labels_of(comparison.system.inputs),
          .paths = static_cast<std::size_t>(comparison.paths)};
}

/// One row per stage (or per element of `axis`), one column per state.
DatasetSpec by_state(const std::string& path, const std::string& axis, const ComparisonSizes& n,
                     const std::string& comment) {
  return {.path = path,
          .row_shape = {n.state_dim()},
          .axes = {axis, "state"},
          .units = n.states.units,
          .columns = n.states.names,
          .comment = comment};
}

/// Paths at the stages, indexed by stage, path, state.
DatasetSpec of_paths(const std::string& path, const ComparisonSizes& n,
                     const std::string& comment) {
  return {.path = path,
          .row_shape = {n.paths, n.state_dim()},
          .axes = {"stage", "path", "state"},
          .units = n.states.units,
          .columns = n.states.names,
          .comment = comment,
          .chunk_rows = 1,
          .compress = true};
}

void add_plan(Layout& layout, const ComparisonSizes& n) {
  layout.push_back({.path = "/plan/inputs",
                    .row_shape = {n.inputs.names.size()},
                    .axes = {"stage", "input"},
                    .units = n.inputs.units,
                    .columns = n.inputs.names,
                    .comment = "nominal inputs v of the policy u(x) = clamp(v + K (x - nominal))"});
  layout.push_back(by_state("/plan/states", "stage", n,
                            "nominal states: under the nominal inputs, without noise"));
  layout.push_back({.path = "/plan/gains",
                    .row_shape = {n.inputs.names.size(), n.state_dim()},
                    .axes = {"stage", "input", "state"},
                    .units = {"unit of the input per unit of the state"},
                    .comment = "K; zero for an open-loop policy"});
}

void add_model(Layout& layout, const ComparisonSizes& n, bool with_error) {
  layout.push_back(of_paths("/model/states", n, "paths of the model; stage 0 is the present"));
  layout.push_back({.path = "/model/w2_floor",
                    .row_shape = {2},
                    .axes = {"stage", "what"},
                    .units = {kStateNorm},
                    .columns = {"mean", "deviation"},
                    .comment = "W2 between the particles and ensembles of the model's own paths, "
                               "and its standard deviation; stage 0 is the present"});
  layout.push_back({.path = "/certificate/without",
                    .axes = {"stage"},
                    .units = {"1"},
                    .comment = "upper bound of the probability that the model is unsafe; the first "
                               "is that of stage 1"});
  if (!with_error) return;
  layout.push_back({.path = "/certificate/with",
                    .axes = {"stage"},
                    .units = {"1"},
                    .comment = "upper bound for plants within the scenario's model error"});
}

void add_closed_loop(Layout& layout, const std::string& group) {
  const auto add = [&](const char* name, Type type, const char* unit, const char* comment) {
    layout.push_back({.path = group + "/closed_loop/" + name,
                      .type = type,
                      .axes = {"episode"},
                      .units = {unit},
                      .comment = comment});
  };
  add("seed", Type::kInt64, "1", "of the episode, as a signed 64-bit integer");
  add("outcome", Type::kText, "1", "how the episode ended");
  add("steps", Type::kInt64, "periods", "");
  add("cost", Type::kFloat64, "1", "closed-loop cost along the true states");
  add("min_clearance", Type::kFloat64, "as the safe set",
      "least distance of the true state to the unsafe set; negative inside");
  add("unsafe", Type::kInt64, "1", "1 where the true state entered the unsafe set");
  add("certified", Type::kFloat64, "1", "sum of the next-step certificates of its periods");
  add("unsafe_periods", Type::kInt64, "periods", "that ended in the unsafe set");
}

/// The period-by-period certificates of the closed loop.
void add_next_step(Layout& layout, const std::string& group) {
  const auto add = [&](const char* name, Type type, const char* comment) {
    layout.push_back({.path = group + "/next_step/" + name,
                      .type = type,
                      .axes = {"period"},
                      .units = {"1"},
                      .comment = comment});
  };
  add("episode", Type::kInt64, "index of the episode's row in closed_loop, from 0");
  add("certified", Type::kFloat64, "upper bound of the probability that the period ends unsafe");
  add("unsafe", Type::kInt64, "1 where it did");
}

void add_residuals(Layout& layout, const std::string& group, const ComparisonSizes& n) {
  const std::string episode = "index of the episode's row in closed_loop, from 0";
  layout.push_back(by_state(group + "/one_step/residuals", "period", n,
                            "x+ - w - f(x, u), episode after episode"));
  layout.push_back({.path = group + "/one_step/episode",
                    .type = Type::kInt64,
                    .axes = {"period"},
                    .units = {"1"},
                    .comment = episode});
  for (const char* name : {"mean", "mean_deviation", "rmse", "rounding"}) {
    layout.push_back({.path = group + "/one_step/" + name,
                      .axes = {"state"},
                      .units = n.states.units,
                      .columns = n.states.names,
                      .chunk_rows = n.state_dim()});
  }
  layout.push_back({.path = group + "/one_step/covariance",
                    .row_shape = {n.state_dim()},
                    .axes = {"state", "state"},
                    .units = n.states.units,
                    .columns = n.states.names,
                    .comment = "an entry has the unit of its row times that of its column",
                    .chunk_rows = n.state_dim()});
  for (const char* name : {"lag1", "ljung_box", "p_value"}) {
    layout.push_back({.path = group + "/one_step/" + name,
                      .axes = {"state"},
                      .units = {"1"},
                      .columns = n.states.names,
                      .chunk_rows = n.state_dim()});
  }
}

void add_horizon(Layout& layout, const std::string& group, const ComparisonSizes& n) {
  layout.push_back(of_paths(group + "/paths/states", n,
                            "paths of the plant under the plan; stage 0 is the present; NaN from "
                            "the stage at which the plant broke"));
  layout.push_back(of_paths(group + "/paths/residuals", n,
                            "x+ - w - f(x, u) of the period that begins at the stage"));
  layout.push_back(by_state(group + "/horizon/divergence_rmse", "stage", n,
                            "of the plant's paths from the model's with the same disturbances; the "
                            "first is that of stage 1"));
  layout.push_back({.path = group + "/horizon/w2",
                    .axes = {"stage"},
                    .units = {kStateNorm},
                    .comment = "between the particles and the plant's paths, from stage 1"});
  layout.push_back({.path = group + "/horizon/unsafe",
                    .type = Type::kInt64,
                    .axes = {"stage"},
                    .units = {"paths"},
                    .comment = "that are unsafe at the stage, from stage 1"});
  layout.push_back({.path = group + "/horizon/rate",
                    .row_shape = {3},
                    .axes = {"stage", "limit"},
                    .units = {"1"},
                    .columns = {"rate", "lower", "upper"},
                    .comment = "share of unsafe paths, and its Clopper-Pearson limits, each wrong "
                               "with a probability of 0.005"});
}

void write_header(Hdf5File& file, const Comparison& comparison) {
  write_file_header(file, {.kind = "comparison",
                           .schema = kComparisonSchema,
                           .version = comparison.version,
                           .scenario_text = comparison.scenario_text,
                           .scenario_name = comparison.scenario.name,
                           .seed = comparison.scenario.seed});
  std::vector<std::string> names;
  for (const PlantComparison& plant : comparison.plants) names.push_back(plant.name);
  file.set_texts("/plants", "names", names);
  file.set_texts("/plants", "groups", plant_groups(comparison));
}

/// Writes each stage as a row: path by path, with the states of a path in sequence.
void append_paths(Hdf5File& file, const std::string& path,
                  const std::vector<controller::Points>& stages) {
  for (const controller::Points& stage : stages) file.append(path, by_rows(stage.transpose()));
}

void write_shared(Hdf5File& file, const Comparison& comparison) {
  const controller::Policy& policy = comparison.policy;
  file.append("/plan/inputs", by_rows(policy.inputs.transpose()));
  file.append("/plan/states", by_rows(policy.states.transpose()));
  for (const Eigen::MatrixXd& gain : policy.gains) file.append("/plan/gains", by_rows(gain));
  append_paths(file, "/model/states", comparison.model_paths);
  file.set_integer("/model", "w2_paths", comparison.w2_paths);
  for (const W2Floor& floor : comparison.floors) {
    file.append("/model/w2_floor", std::vector<double>{floor.mean, floor.deviation});
  }
  file.append("/certificate/without",
              column_of(comparison.certificates, &controller::StageCertificate::value));
  if (comparison.with_error) {
    file.append("/certificate/with",
                column_of(*comparison.with_error, &controller::StageCertificate::value));
  }
}

void write_closed_loop(Hdf5File& file, const std::string& group,
                       const std::vector<EpisodeResult>& episodes) {
  const auto append = [&]<class Value>(const char* name, const std::vector<Value>& values) {
    file.append(group + "/closed_loop/" + name, values);
  };
  std::vector<std::int64_t> seeds;
  std::vector<std::int64_t> steps;
  std::vector<std::int64_t> unsafe;
  std::vector<std::int64_t> unsafe_periods;
  std::vector<double> certified;
  for (const EpisodeResult& episode : episodes) {
    seeds.push_back(static_cast<std::int64_t>(episode.seed));
    steps.push_back(episode.steps);
    unsafe.push_back(episode.unsafe ? 1 : 0);
    unsafe_periods.push_back(std::ranges::count(episode.unsafe_next, 1));
    double sum = 0.0;
    for (const double probability : episode.certified) sum += probability;
    certified.push_back(sum);
  }
  append("seed", seeds);
  append("outcome", column_of(episodes, &EpisodeResult::outcome));
  append("steps", steps);
  append("cost", column_of(episodes, &EpisodeResult::cost));
  append("min_clearance", column_of(episodes, &EpisodeResult::min_clearance));
  append("unsafe", unsafe);
  append("certified", certified);
  append("unsafe_periods", unsafe_periods);
}

void write_next_step(Hdf5File& file, const std::string& group,
                     const std::vector<EpisodeResult>& episodes) {
  for (std::size_t n = 0; n < episodes.size(); ++n) {
    const EpisodeResult& episode = episodes[n];
    file.append(group + "/next_step/episode",
                std::vector<std::int64_t>(episode.certified.size(), static_cast<std::int64_t>(n)));
    file.append(group + "/next_step/certified", episode.certified);
    file.append(group + "/next_step/unsafe",
                std::vector<std::int64_t>(episode.unsafe_next.begin(), episode.unsafe_next.end()));
  }
}

void write_residuals(Hdf5File& file, const std::string& group, const PlantComparison& plant) {
  for (std::size_t n = 0; n < plant.episodes.size(); ++n) {
    const Eigen::MatrixXd& residuals = plant.episodes[n].residuals;
    file.append(group + "/one_step/residuals", by_rows(residuals.transpose()));
    file.append(group + "/one_step/episode",
                std::vector<std::int64_t>(static_cast<std::size_t>(residuals.cols()),
                                          static_cast<std::int64_t>(n)));
  }
  const ResidualStatistics& one_step = plant.one_step;
  file.append(group + "/one_step/mean", by_rows(one_step.mean));
  file.append(group + "/one_step/mean_deviation", by_rows(one_step.mean_deviation));
  file.append(group + "/one_step/rmse", by_rows(one_step.rmse));
  file.append(group + "/one_step/rounding", by_rows(one_step.rounding));
  file.append(group + "/one_step/covariance", by_rows(one_step.covariance));
  file.append(group + "/one_step/lag1", by_rows(one_step.whiteness.lag1));
  file.append(group + "/one_step/ljung_box", by_rows(one_step.whiteness.ljung_box));
  file.append(group + "/one_step/p_value", by_rows(one_step.whiteness.p_value));
}

void write_horizon(Hdf5File& file, const std::string& group, const PlantComparison& plant,
                   std::int64_t paths) {
  append_paths(file, group + "/paths/states", plant.paths.states);
  append_paths(file, group + "/paths/residuals", plant.paths.residuals);
  file.set_integer(group + "/paths", "faults", plant.paths.faults);
  for (const HorizonStage& stage : plant.horizon) {
    file.append(group + "/horizon/divergence_rmse", by_rows(stage.divergence_rmse));
    file.append(group + "/horizon/w2", std::vector<double>{stage.w2});
    file.append(group + "/horizon/unsafe", std::vector<std::int64_t>{stage.unsafe});
    file.append(group + "/horizon/rate",
                std::vector<double>{static_cast<double>(stage.unsafe) / static_cast<double>(paths),
                                    stage.unsafe_limits.lower, stage.unsafe_limits.upper});
  }
}

void write_hdf5(const Comparison& comparison, const std::string& path) {
  Hdf5File file = Hdf5File::create(path);
  for (const DatasetSpec& spec : comparison_layout(comparison)) file.create_dataset(spec);
  write_header(file, comparison);
  write_shared(file, comparison);
  const std::vector<std::string> groups = plant_groups(comparison);
  for (std::size_t n = 0; n < groups.size(); ++n) {
    const PlantComparison& plant = comparison.plants[n];
    file.set_text(groups[n], "name", plant.name);
    write_closed_loop(file, groups[n], plant.episodes);
    write_next_step(file, groups[n], plant.episodes);
    write_residuals(file, groups[n], plant);
    write_horizon(file, groups[n], plant, comparison.paths);
  }
  file.append("/timing/speed", column_of(comparison.plants, &PlantComparison::speed));
  file.close();
}

}  // namespace

std::vector<std::string> plant_groups(const Comparison& comparison) {
  std::vector<std::string> groups;
  for (const PlantComparison& plant : comparison.plants) {
    std::string group = "/plants/";
    for (const char c : plant.name) {
      const bool plain = std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '-' ||
                         (c == '.' && group.back() != '/');
      group += plain ? c : '_';
    }
    const std::string base = group;
    for (int n = 2; std::ranges::find(groups, group) != groups.end(); ++n) {
      group = fmt::format("{}_{}", base, n);
    }
    groups.push_back(group);
  }
  return groups;
}

std::vector<DatasetSpec> comparison_layout(const Comparison& comparison) {
  const ComparisonSizes sizes = comparison_sizes(comparison);
  Layout layout;
  add_plan(layout, sizes);
  add_model(layout, sizes, comparison.with_error.has_value());
  for (const std::string& group : plant_groups(comparison)) {
    add_closed_loop(layout, group);
    add_next_step(layout, group);
    add_residuals(layout, group, sizes);
    add_horizon(layout, group, sizes);
  }
  layout.push_back({.path = "/timing/speed",
                    .axes = {"plant"},
                    .units = {"s/s"},
                    .comment = "simulated seconds per wall-clock second of one plant"});
  return layout;
}

void write_comparison(const Comparison& comparison, const std::vector<TextFile>& more,
                      const std::string& folder) {
  FileGroup files;
  const PendingFile& data = files.add(folder + "/" + kComparisonFile);
  files.add(folder + "/" + kScenarioFile).write(comparison.scenario_text);
  for (const TextFile& file : more) files.add(file.path).write(file.text);
  files.add(folder + "/" + kComparisonNumbersFile).write(comparison_json(comparison));
  write_hdf5(comparison, data.partial_path());
  // An old comparison.json must never stand beside a new comparison.h5.
  files.commit_sealed();
}

}  // namespace qsmpc::harness
