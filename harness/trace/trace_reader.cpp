// read_trace: the reading side of trace_file.hpp.
#include <algorithm>
#include <filesystem>
#include <iterator>
#include <optional>
#include <stdexcept>
#include <system_error>
#include <utility>
#include <vector>

#include "harness/assembly/assembly.hpp"
#include "harness/errors.hpp"
#include "harness/files/atomic_file.hpp"
#include "harness/scenario/model_dynamics.hpp"
#include "harness/scenario/scenario_file.hpp"
#include "harness/trace/certificate_fields.hpp"
#include "harness/trace/cost_fields.hpp"
#include "harness/trace/ending.hpp"
#include "harness/trace/residuals.hpp"
#include "harness/trace/system_group.hpp"
#include "harness/trace/trace_file.hpp"
#include "harness/trace/trace_layout.hpp"
#include "models/constants.hpp"

namespace qsmpc::harness {
namespace {

using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Reads one file's groups into a trace. A step counts only if it has a time.
class TraceReader {
 public:
  explicit TraceReader(const std::string& path) : file_(Hdf5File::open(path)) {}

  Trace read();

 private:
  [[noreturn]] void refuse(const std::string& key, const std::string& found,
                           const std::string& expected) const {
    throw InputError({.file = file_.path(), .key = key, .found = found, .expected = expected});
  }
  void read_header();
  void read_outcome();
  void read_description();
  void check_shapes();
  void read_motion();
  void read_final_state();
  void read_plant_and_belief();
  void read_obstacles();
  void read_between();
  void read_believed();
  void read_policy();
  void read_solution();
  void read_particles();
  void read_budgets();
  void read_certificates();
  void read_timing();

  /// The numbers of a dataset that older traces lack; empty if it is missing.
  [[nodiscard]] std::vector<double> doubles_if_there(const std::string& path) const {
    return file_.has_dataset(path) ? file_.doubles(path) : std::vector<double>();
  }
  /// The numbers of step `k` in a dataset with `row` numbers per step.
  [[nodiscard]] static const double* row_of(const std::vector<double>& values, std::size_t k,
                                            Eigen::Index row) {
    return values.data() + k * static_cast<std::size_t>(row);
  }

  Hdf5File file_;
  Trace trace_;
  Eigen::Index state_dim_ = 0;
  Eigen::Index input_dim_ = 0;
  controller::DecisionParts parts_;
  std::size_t stages_ = 0;  // with a certificate
};

Trace TraceReader::read() {
  read_header();
  read_description();
  check_shapes();
  read_motion();
  read_final_state();
  read_plant_and_belief();
  read_obstacles();
  read_between();
  read_believed();
  if (parts_.stages > 0) read_policy();
  read_solution();
  if (parts_.particles) read_particles();
  read_budgets();
  read_certificates();
  read_timing();
  read_outcome();
  if (!file_.has_dataset(kResidualPath)) add_residuals(trace_, *model_of(trace_.scenario));
  return std::move(trace_);
}

void TraceReader::read_header() {
  const std::string schema = "schema " + std::to_string(kTraceSchema);
  if (!file_.has_attribute("/", "schema")) {
    refuse("/@schema", "no such attribute", "a trace of " + schema);
  }
  if (const std::int64_t found = file_.integer("/", "schema"); found != kTraceSchema) {
    refuse("/@schema", "schema " + std::to_string(found), "a trace of " + schema);
  }
  trace_.version = file_.text("/", "version");
  trace_.scenario_text = file_.text("/", "scenario");
  trace_.seed = file_.unsigned_integer("/", "seed");
  trace_.fault = file_.text("/", "fault");
  // Earlier versions had only built-in controllers.
  if (file_.has_attribute("/", kFaultOf) &&
      file_.text("/", kFaultOf) == fault_of_name(FaultOf::kController)) {
    trace_.fault_of = FaultOf::kController;
  }
  if (file_.has_attribute("/", "vehicle_digest")) {
    trace_.vehicle_digest = file_.text("/", "vehicle_digest");
  }
  const std::string outcome = file_.text("/", "outcome");
  try {
    // The part of the unsafe set follows from the states, which are read later.
    trace_.outcome = outcome == kLeftSafeSet ? Outcome::kCollision : outcome_from_name(outcome);
  } catch (const std::invalid_argument&) {
    refuse("/@outcome", outcome, outcome_list());
  }
  const std::string& path = file_.path();
  trace_.scenario = parse_scenario(
      trace_.scenario_text,
      {.file = path, .folder = path.substr(0, path.rfind('/') + 1), .files_must_exist = false});
  parts_ = decision_parts(trace_.scenario);
  stages_ = static_cast<std::size_t>(certified_stages(parts_));
}

/// Earlier versions had one outcome for both parts of the unsafe set, and none for a drive that
/// continued after it was unsafe: its outcome was "reached" or "timeout".
void TraceReader::read_outcome() {
  const bool is_left_safe_set = file_.text("/", "outcome") == kLeftSafeSet;
  const bool may_hide_it =
      trace_.outcome == Outcome::kReached || trace_.outcome == Outcome::kTimeout;
  if (!is_left_safe_set && !may_hide_it) return;
  const std::optional<Outcome> unsafe = first_unsafe_outcome(trace_);
  if (unsafe) trace_.outcome = *unsafe;
  if (is_left_safe_set && !unsafe) {
    refuse("/@outcome", kLeftSafeSet, "a trace with a state in the unsafe set");
  }
}

/// Takes the system's description from the scenario if the trace predates its recording.
void TraceReader::read_description() {
  const Scenario& scenario = trace_.scenario;
  trace_.system = has_system(file_) ? read_system(file_) : system_of(scenario);
  state_dim_ = std::ssize(trace_.system.states);
  input_dim_ = std::ssize(trace_.system.inputs);
  const auto expect = [this](const char* key, Eigen::Index found, Eigen::Index expected) {
    if (found != expected) refuse(key, std::to_string(found), std::to_string(expected));
  };
  expect("/system/states@names", state_dim_, scenario.initial_state.mean.size());
  expect("/system/inputs@names", input_dim_, scenario.controller.input_lower.size());
}

void TraceReader::check_shapes() {
  const auto shape_of_time = file_.shape("/plant/time");
  const std::size_t steps = shape_of_time.empty() ? 0 : shape_of_time.front();
  for (const DatasetSpec& spec : trace_layout(trace_.scenario, trace_.system)) {
    if (may_be_missing(spec.path) && !file_.has_dataset(spec.path)) continue;
    const std::vector<std::size_t> found = file_.shape(spec.path);
    if (found.size() != spec.row_shape.size() + 1) {
      refuse(spec.path, std::to_string(found.size()) + " dimensions",
             std::to_string(spec.row_shape.size() + 1));
    }
    if (spec.axes.front() == "step" && found.front() < steps) {
      refuse(spec.path, std::to_string(found.front()) + " rows", std::to_string(steps));
    }
    for (std::size_t i = 0; i < spec.row_shape.size(); ++i) {
      if (spec.row_shape[i] != 0 && spec.row_shape[i] != found[i + 1]) {
        refuse(spec.path, std::to_string(found[i + 1]) + " along " + spec.axes[i + 1],
               std::to_string(spec.row_shape[i]));
      }
    }
  }
  trace_.steps.resize(steps);
}

void TraceReader::read_motion() {
  const std::vector<double> times = file_.doubles("/plant/motion/time");
  const std::vector<double> positions = file_.doubles("/plant/motion/qpos");
  const std::size_t coordinates = file_.shape("/plant/motion/qpos")[1];
  std::size_t samples = times.size();
  if (coordinates > 0) samples = std::min(samples, positions.size() / coordinates);
  // A run that was killed within a step may have left one without the other.
  if (samples < times.size() && trace_.outcome != Outcome::kInterrupted) {
    refuse("/plant/motion/qpos", std::to_string(samples) + " rows", std::to_string(times.size()));
  }
  for (std::size_t i = 0; i < samples; ++i) {
    const auto begin = positions.begin() + static_cast<std::ptrdiff_t>(i * coordinates);
    trace_.motion.push_back(
        {.time = times[i], .qpos = {begin, begin + static_cast<std::ptrdiff_t>(coordinates)}});
  }
}

void TraceReader::read_final_state() {
  const std::vector<double> state = file_.doubles("/plant/final_state");
  if (!state.empty() && state.size() != static_cast<std::size_t>(state_dim_)) {
    refuse("/plant/final_state", std::to_string(state.size()) + " numbers",
           std::to_string(state_dim_));
  }
  trace_.final_state = Eigen::Map<const Eigen::VectorXd>(state.data(), std::ssize(state));
}

void TraceReader::read_plant_and_belief() {
  const auto times = file_.doubles("/plant/time");
  const auto states = file_.doubles("/plant/state");
  const auto seen = doubles_if_there(kObservationPath);
  const auto inputs = file_.doubles("/plant/input");
  const auto disturbances = file_.doubles("/plant/disturbance");
  const auto residuals = doubles_if_there(kResidualPath);
  const auto means = file_.doubles("/belief/mean");
  const auto covariances = file_.doubles("/belief/covariance");
  using Vector = Eigen::Map<const Eigen::VectorXd>;
  for (std::size_t k = 0; k < trace_.steps.size(); ++k) {
    StepRecord& step = trace_.steps[k];
    step.time = times[k];
    step.state = Vector(row_of(states, k, state_dim_), state_dim_);
    step.observation = Vector(row_of(seen.empty() ? states : seen, k, state_dim_), state_dim_);
    step.input = Vector(row_of(inputs, k, input_dim_), input_dim_);
    step.disturbance = Vector(row_of(disturbances, k, state_dim_), state_dim_);
    if (!residuals.empty()) {
      step.residual = Vector(row_of(residuals, k, state_dim_), state_dim_);
    }
    step.belief_mean = Vector(row_of(means, k, state_dim_), state_dim_);
    step.belief_covariance = Eigen::Map<const RowMajor>(
        row_of(covariances, k, state_dim_ * state_dim_), state_dim_, state_dim_);
  }
}

void TraceReader::read_obstacles() {
  const Eigen::Index count = std::ssize(controller::moving_obstacles(trace_.scenario.safe_set));
  if (count == 0) return;
  const auto poses = file_.doubles(kObstaclePosePath);
  const auto seen = file_.doubles(kObstacleSeenPath);
  const auto last = file_.doubles(kObstacleFinalPath);
  // An obstacle is a row in the file and a column in memory.
  for (std::size_t k = 0; k < trace_.steps.size(); ++k) {
    StepRecord& step = trace_.steps[k];
    step.obstacles = Eigen::Map<const Eigen::Matrix3Xd>(row_of(poses, k, 3 * count), 3, count);
    step.obstacles_seen = Eigen::Map<const Eigen::Matrix2Xd>(row_of(seen, k, 2 * count), 2, count);
  }
  if (last.empty()) return;
  if (std::ssize(last) != 3 * count) {
    refuse(kObstacleFinalPath, std::to_string(last.size()) + " numbers", std::to_string(3 * count));
  }
  trace_.final_obstacles = Eigen::Map<const Eigen::Matrix3Xd>(last.data(), 3, count);
}

void TraceReader::read_believed() {
  const auto believed = doubles_if_there(kBelievedPath);
  if (believed.empty()) return;
  for (std::size_t k = 0; k < trace_.steps.size(); ++k) trace_.steps[k].believed = believed[k];
}

void TraceReader::read_between() {
  const auto clearances = doubles_if_there(kBetweenPath);
  const auto forces = doubles_if_there(kContactForcePath);
  const auto times = doubles_if_there(kContactTimePath);
  for (std::size_t k = 0; k < trace_.steps.size(); ++k) {
    StepRecord& step = trace_.steps[k];
    if (!clearances.empty()) step.clearance_between = clearances[k];
    if (!forces.empty()) step.contact.force = forces[k];
    if (!times.empty()) step.contact.time = times[k];
  }
}

void TraceReader::read_policy() {
  const Eigen::Index horizon = parts_.stages;
  const auto inputs = file_.doubles("/plan/inputs");
  const auto states = file_.doubles("/plan/states");
  const auto gains = doubles_if_there(kGainsPath);
  // A stage is a row in the file and a column in memory.
  using Columns = Eigen::Map<const Eigen::MatrixXd>;
  for (std::size_t k = 0; k < trace_.steps.size(); ++k) {
    StepRecord& step = trace_.steps[k];
    step.plan_inputs = Columns(row_of(inputs, k, input_dim_ * horizon), input_dim_, horizon);
    step.plan_states =
        Columns(row_of(states, k, state_dim_ * (horizon + 1)), state_dim_, horizon + 1);
    if (gains.empty()) continue;
    const double* gain = row_of(gains, k, horizon * input_dim_ * state_dim_);
    for (Eigen::Index s = 0; s < horizon; ++s, gain += input_dim_ * state_dim_) {
      step.plan_gains.emplace_back(Eigen::Map<const RowMajor>(gain, input_dim_, state_dim_));
    }
  }
}

void TraceReader::read_solution() {
  for (StepRecord& step : trace_.steps) {
    step.cost = controller::CostParts::all(kNotANumber);
  }
  if (parts_.cost) {
    const auto costs = file_.doubles("/plan/cost");
    for (std::size_t k = 0; k < trace_.steps.size(); ++k) {
      const auto count = std::ssize(controller::cost_parts());
      const double* cost = row_of(costs, k, count);
      for (std::ptrdiff_t part = 0; part < count; ++part) trace_.steps[k].cost[part] = cost[part];
    }
  }
  if (!parts_.status) return;
  const auto statuses = file_.texts("/plan/status");
  const auto fallbacks = file_.integers("/plan/fallback");
  const auto iterations = file_.integers("/plan/iterations");
  for (std::size_t k = 0; k < trace_.steps.size(); ++k) {
    StepRecord& step = trace_.steps[k];
    step.solver_status = statuses[k];
    step.fallback = fallbacks[k] != 0;
    step.iterations = static_cast<int>(iterations[k]);
  }
}

void TraceReader::read_particles() {
  const auto locations = file_.doubles("/particles/locations");
  const auto weights = file_.doubles("/particles/weights");
  const auto offsets = file_.integers("/particles/offsets");
  const auto points = static_cast<std::int64_t>(
      std::min(weights.size(), locations.size() / static_cast<std::size_t>(state_dim_)));
  const auto boundaries = static_cast<std::size_t>(parts_.stages) + 2;
  for (std::size_t k = 0; k < trace_.steps.size(); ++k) {
    const std::int64_t* const bounds = offsets.data() + k * boundaries;
    for (std::size_t s = 0; s + 1 < boundaries; ++s) {
      const std::int64_t begin = bounds[s];
      const std::int64_t count = bounds[s + 1] - begin;
      if (begin < 0 || begin > points || count < 0 || count > points - begin) {
        refuse("/particles/offsets", std::to_string(begin) + " to " + std::to_string(bounds[s + 1]),
               "non-decreasing offsets up to " + std::to_string(points));
      }
      const auto first = static_cast<std::size_t>(begin);
      trace_.steps[k].particles.push_back(
          {.locations = Eigen::Map<const Eigen::MatrixXd>(row_of(locations, first, state_dim_),
                                                          state_dim_, count),
           .weights = Eigen::Map<const Eigen::VectorXd>(weights.data() + first, count)});
    }
  }
}

void TraceReader::read_budgets() {
  const auto budgets = file_.doubles("/certificate/budget");
  const auto lipschitz = file_.doubles("/certificate/lipschitz");
  const auto dynamics = doubles_if_there(kDynamicsPath);
  const auto model = doubles_if_there(kModelErrorPath);
  const std::size_t stages = stages_ + 1;
  for (std::size_t k = 0; k < trace_.steps.size(); ++k) {
    for (std::size_t i = k * stages; i < (k + 1) * stages; ++i) {
      // The version that wrote a trace without this dataset had no model errors.
      controller::StageBudget budget{.model = model.empty() ? 0.0 : model[i],
                                     .dynamics = dynamics.empty() ? kNotANumber : dynamics[i],
                                     .lipschitz = lipschitz[i]};
      const double* const columns = row_of(budgets, i, std::ssize(kBudgetColumns));
      for (std::size_t c = 0; c < kBudgetColumns.size(); ++c) {
        budget.*kBudgetColumns[c].member = columns[c];
      }
      trace_.steps[k].budgets.push_back(budget);
    }
  }
}

void TraceReader::read_certificates() {
  const auto kinds = file_.texts("/certificate/kind");
  for (std::size_t k = 0; k < trace_.steps.size(); ++k) {
    trace_.steps[k].certificates.assign(stages_, controller::blank_certificate());
    for (std::size_t s = 0; s < stages_; ++s) {
      trace_.steps[k].certificates[s].kind = kinds[k * stages_ + s];
    }
  }
  const auto for_stages = [&](const std::vector<double>& values, const auto& take) {
    for (std::size_t k = 0; k < trace_.steps.size(); ++k) {
      for (std::size_t s = 0; s < stages_; ++s) {
        take(trace_.steps[k].certificates[s], values[k * stages_ + s]);
      }
    }
  };
  for_stages(file_.doubles(kCertificateValuePath),
             [](controller::StageCertificate& stage, double value) { stage.value = value; });
  const std::vector<controller::CertificateEntry>& entries = controller::certificate_entries();
  for (std::size_t i = 0; i < entries.size(); ++i) {
    // A missing bound keeps its default: it was not computed.
    const auto values = doubles_if_there(certificate_path(entries[i]));
    if (values.empty()) continue;
    for_stages(values, [i](controller::StageCertificate& stage, double value) {
      stage.figures[i] = value;
    });
  }
}

void TraceReader::read_timing() {
  const auto read_one = [&](const char* path, double StepTiming::*member) {
    const auto values = file_.doubles(path);
    for (std::size_t k = 0; k < trace_.steps.size(); ++k) {
      trace_.steps[k].timing.*member = values[k];
    }
  };
  read_one("/timing/quantise", &StepTiming::quantise);
  read_one("/timing/propagate", &StepTiming::propagate);
  read_one("/timing/optimise", &StepTiming::optimise);
  read_one("/timing/certify", &StepTiming::certify);
  read_one("/timing/total", &StepTiming::total);
  read_one("/timing/simulate", &StepTiming::simulate);
}

}  // namespace

Trace read_trace(const std::string& path) { return TraceReader(path).read(); }

Trace read_folder(const std::string& folder) {
  const std::string path = folder + "/" + kTraceFile;
  const std::string partial = partial_path_of(path);
  std::error_code ignored;
  const bool killed =
      !std::filesystem::exists(path, ignored) && std::filesystem::exists(partial, ignored);
  return read_trace(killed ? partial : path);
}

}  // namespace qsmpc::harness
