// TraceWriter: the writing side of trace_file.hpp.
#include "harness/trace/trace_writer.hpp"

#include <iterator>
#include <stdexcept>
#include <utility>
#include <vector>

#include "harness/assembly/assembly.hpp"
#include "harness/errors.hpp"
#include "harness/files/atomic_file.hpp"
#include "harness/trace/certificate_datasets.hpp"
#include "harness/trace/cost_fields.hpp"
#include "harness/trace/file_header.hpp"
#include "harness/trace/rows.hpp"
#include "harness/trace/system_group.hpp"
#include "harness/trace/trace_file.hpp"
#include "harness/trace/trace_layout.hpp"

namespace qsmpc::harness {
namespace {

void require(bool condition, const char* what) {
  if (!condition) throw std::invalid_argument(std::string("step record: ") + what);
}

void write_trace_header(Hdf5File& file, const Trace& header) {
  write_file_header(file, {.schema = kTraceSchema,
                           .version = header.version,
                           .scenario_text = header.scenario_text,
                           .scenario_name = header.scenario.name,
                           .seed = header.seed});
  if (!header.vehicle_digest.empty()) {
    file.set_text("/", "vehicle_digest", header.vehicle_digest);
  }
  // What a reader sees if nothing is ever added.
  file.set_text("/", "outcome", outcome_name(Outcome::kInterrupted));
  file.set_text("/", "fault", "");
}

}  // namespace

TraceWriter::TraceWriter(std::string path, const Trace& header)
    : path_(std::move(path)),
      file_(Hdf5File::create(partial_path_of(path_))),
      state_dim_(std::ssize(header.system.states)),
      input_dim_(std::ssize(header.system.inputs)),
      is_solid_(header.scenario.plant.solid),
      obstacles_(std::ssize(controller::moving_obstacles(header.scenario.safe_set))),
      parts_(decision_parts(header.scenario)),
      stages_(certified_stages(parts_)) {
  write_trace_header(file_, header);
  write_system(file_, header.system);
  for (const DatasetSpec& spec : trace_layout(header.scenario, header.system)) {
    file_.create_dataset(spec);
  }
  file_.flush();
  file_.begin_streaming();
}

void TraceWriter::append(const StepRecord& record, std::span<const MotionSample> motion) {
  if (broken_) throw IoError(path_ + ": an earlier step could not be written");
  check_sizes(record);
  broken_ = true;
  append_motion(motion);
  append_vectors(record);
  append_plan(record);
  file_.append(kBelievedPath, std::vector<double>{record.believed});
  if (parts_.particles) append_particles(record);
  append_certificates(file_, record.budgets, record.certificates);
  append_timing(record.timing);
  // The time marks the step as complete: it is written only after everything else of the step, and
  // the reader accepts as many steps as there are times.
  file_.flush();
  file_.append("/plant/time", std::vector<double>{record.time});
  file_.flush();
  broken_ = false;
}

void TraceWriter::check_sizes(const StepRecord& record) const {
  require(record.state.size() == state_dim_, "state is not state_dim");
  require(record.observation.size() == state_dim_, "observation is not state_dim");
  require(record.input.size() == input_dim_, "input is not input_dim");
  require(record.disturbance.size() == state_dim_, "disturbance is not state_dim");
  require(record.residual.size() == state_dim_, "residual is not state_dim");
  require(record.belief_mean.size() == state_dim_, "belief_mean is not state_dim");
  require(record.belief_covariance.rows() == state_dim_ &&
              record.belief_covariance.cols() == state_dim_,
          "belief_covariance is not state_dim x state_dim");
  require(record.obstacles.cols() == obstacles_ && record.obstacles_seen.cols() == obstacles_,
          "obstacles are not one per moving obstacle");
  const auto stages = static_cast<std::size_t>(stages_);
  require(record.budgets.size() == stages + 1, "budgets are not stages + 1");
  require(record.certificates.size() == stages, "certificates are not stages");
  if (parts_.stages > 0) check_plan(record);
}

void TraceWriter::check_plan(const StepRecord& record) const {
  const Eigen::Index horizon = parts_.stages;
  require(record.plan_inputs.rows() == input_dim_ && record.plan_inputs.cols() == horizon,
          "plan_inputs are not input_dim x horizon");
  require(record.plan_states.rows() == state_dim_ && record.plan_states.cols() == horizon + 1,
          "plan_states are not state_dim x (horizon + 1)");
  require(std::ssize(record.plan_gains) == horizon, "plan_gains are not horizon");
  for (const Eigen::MatrixXd& gain : record.plan_gains) {
    require(gain.rows() == input_dim_ && gain.cols() == state_dim_,
            "plan_gains are not input_dim x state_dim");
  }
  if (!parts_.particles) return;
  require(std::ssize(record.particles) == horizon + 1, "particles are not horizon + 1");
  for (const StageParticles& stage : record.particles) {
    require(stage.locations.rows() == state_dim_, "particles are not of state_dim");
    require(stage.locations.cols() == stage.weights.size(), "particles without a weight");
  }
}

void TraceWriter::append_motion(std::span<const MotionSample> motion) {
  if (motion.empty()) return;
  if (!motion_begun_) {
    motion_begun_ = true;
    qpos_size_ = motion.front().qpos.size();
    file_.set_columns("/plant/motion/qpos", qpos_size_);
  }
  std::vector<double> times;
  std::vector<double> positions;
  for (const MotionSample& sample : motion) {
    require(sample.qpos.size() == qpos_size_, "motion samples differ in size");
    times.push_back(sample.time);
    append_to(positions, sample.qpos);
  }
  file_.append("/plant/motion/qpos", positions);
  file_.append("/plant/motion/time", times);
}

void TraceWriter::append_vectors(const StepRecord& record) {
  file_.append("/plant/state", by_rows(record.state));
  file_.append(kObservationPath, by_rows(record.observation));
  file_.append("/plant/input", by_rows(record.input));
  file_.append("/plant/disturbance", by_rows(record.disturbance));
  file_.append(kResidualPath, by_rows(record.residual));
  file_.append(kBetweenPath, std::vector<double>{record.clearance_between});
  if (is_solid_) {
    file_.append(kContactForcePath, std::vector<double>{record.contact.force});
    file_.append(kContactTimePath, std::vector<double>{record.contact.time});
  }
  if (obstacles_ > 0) {
    // An obstacle is a column in memory and a row in the file.
    file_.append(kObstaclePosePath, by_rows(record.obstacles.transpose()));
    file_.append(kObstacleSeenPath, by_rows(record.obstacles_seen.transpose()));
  }
  file_.append("/belief/mean", by_rows(record.belief_mean));
  file_.append("/belief/covariance", by_rows(record.belief_covariance));
}

void TraceWriter::append_plan(const StepRecord& record) {
  if (parts_.stages > 0) {
    // A stage is a column in memory and a row in the file.
    file_.append("/plan/inputs", by_rows(record.plan_inputs.transpose()));
    file_.append("/plan/states", by_rows(record.plan_states.transpose()));
    std::vector<double> gains;
    for (const Eigen::MatrixXd& gain : record.plan_gains) append_to(gains, by_rows(gain));
    file_.append(kGainsPath, gains);
  }
  if (parts_.cost) file_.append("/plan/cost", cost_row(record.cost));
  if (!parts_.status) return;
  file_.append("/plan/status", std::vector<std::string>{record.solver_status});
  file_.append("/plan/fallback", std::vector<std::int64_t>{record.fallback ? 1 : 0});
  file_.append("/plan/iterations", std::vector<std::int64_t>{record.iterations});
}

void TraceWriter::append_particles(const StepRecord& record) {
  std::vector<std::int64_t> offsets = {points_};
  std::vector<double> locations;
  std::vector<double> weights;
  for (const StageParticles& stage : record.particles) {
    append_to(locations, by_rows(stage.locations.transpose()));
    append_to(weights, by_rows(stage.weights));
    points_ += stage.weights.size();
    offsets.push_back(points_);
  }
  file_.append("/particles/locations", locations);
  file_.append("/particles/weights", weights);
  file_.append("/particles/offsets", offsets);
}

void TraceWriter::append_timing(const StepTiming& timing) {
  const auto append_one = [&](const char* path, double value) {
    file_.append(path, std::vector<double>{value});
  };
  append_one("/timing/quantise", timing.quantise);
  append_one("/timing/propagate", timing.propagate);
  append_one("/timing/optimise", timing.optimise);
  append_one("/timing/certify", timing.certify);
  append_one("/timing/total", timing.total);
  append_one("/timing/simulate", timing.simulate);
}

void TraceWriter::finish(const Trace& trace) {
  if (broken_) throw IoError(path_ + ": an earlier step could not be written");
  if (trace.final_state.size() != 0 && trace.final_state.size() != state_dim_) {
    throw std::invalid_argument("final_state is not state_dim");
  }
  file_.append("/plant/final_state", by_rows(trace.final_state));
  if (obstacles_ > 0) {
    file_.append(kObstacleFinalPath, by_rows(trace.final_obstacles.transpose()));
  }
  file_.end_streaming();
  file_.set_text("/", "outcome", outcome_name(trace.outcome));
  file_.set_text("/", "fault", trace.fault);
  // Not set for other outcomes: with more than eight attributes HDF5 keeps them in a separate tree,
  // whose memory it leaks if the disk is full.
  if (trace.outcome == Outcome::kFault) {
    file_.set_text("/", kFaultOf, fault_of_name(trace.fault_of));
  }
  file_.close();
  commit_partial_file(path_);
}

void write_controller_log(const Trace& trace, const std::string& folder) {
  const std::string path = folder + "/" + kControllerLog;
  if (trace.controller_log.empty()) {
    remove_file(path);
  } else {
    write_file(path, trace.controller_log);
  }
}

void write_trace(const std::string& path, const Trace& trace) {
  TraceWriter writer(path, trace);
  bool first = true;
  for (const StepRecord& step : trace.steps) {
    writer.append(step, first ? std::span(trace.motion) : std::span<const MotionSample>());
    first = false;
  }
  writer.finish(trace);
}

}  // namespace qsmpc::harness
