#include "harness/trace/trace_file.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <filesystem>
#include <limits>
#include <thread>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "harness/errors.hpp"
#include "harness/trace/episode_view.hpp"
#include "harness/trace/system_group.hpp"
#include "harness/trace/trace_layout.hpp"
#include "harness/trace/trace_writer.hpp"
#include "tests/support/example_trace.hpp"
#include "tests/unit/trace/trace_folder.hpp"
#include "tests/unit/trace/trace_matchers.hpp"

namespace qsmpc::harness {
namespace trace_file_test {

namespace fs = std::filesystem;
using testing::example_trace;
using testing::expect_same_step;
using ::testing::HasSubstr;
using testing::same_bits;

class TraceFile : public testing::TraceFolder {};

/// As large as the example's, but otherwise unlike any scenario's.
models::SystemDescription unlike_any_system() {
  return {.name = "kite",
          .summary = "a kite — on a line",
          .states = {{"length", "m"}, {"elevation", "rad", true}, {"azimuth", "rad", true}},
          .inputs = {{"pull", ""}},
          .input_lower = Eigen::VectorXd::Constant(1, -HUGE_VAL),
          .input_upper = Eigen::VectorXd::Constant(1, 0.1),
          .position_x = 2,
          .heading = 1};
}

TEST_F(TraceFile, reading_gives_back_what_was_written_bit_for_bit) {
  Trace trace = testing::example_trace();
  trace.fault = "it said \"bang\" — and stopped";
  trace.outcome = Outcome::kFault;
  trace.system = unlike_any_system();
  trace.steps[1].residual[2] = std::numeric_limits<double>::quiet_NaN();
  trace.steps[1].state[0] = std::bit_cast<double>(0x7FF800000000BEEFULL);  // NaN with a payload
  trace.steps[2].certificates[0].value = -0.0;
  trace.steps[3].timing.total = std::numeric_limits<double>::infinity();
  trace.steps[4].particles[1] = {.locations = models::StateBatch(3, 0),
                                 .weights = Eigen::VectorXd(0)};
  write_trace(path(), trace);

  const Trace read = read_trace(path());

  EXPECT_EQ(read.version, trace.version);
  EXPECT_EQ(read.seed, trace.seed);
  EXPECT_EQ(read.scenario_text, trace.scenario_text);
  EXPECT_EQ(to_yaml(read.scenario), trace.scenario_text);
  testing::expect_same_system(read.system, trace.system);
  EXPECT_EQ(read.outcome, trace.outcome);
  EXPECT_EQ(read.fault, trace.fault);
  EXPECT_TRUE(testing::same_bits(read.final_state, trace.final_state));
  ASSERT_EQ(read.steps.size(), trace.steps.size());
  for (std::size_t k = 0; k < read.steps.size(); ++k) {
    testing::expect_same_step(read.steps[k], trace.steps[k]);
  }
  ASSERT_EQ(read.motion.size(), trace.motion.size());
  for (std::size_t i = 0; i < read.motion.size(); ++i) {
    EXPECT_EQ(read.motion[i].time, trace.motion[i].time);
    EXPECT_EQ(read.motion[i].qpos, trace.motion[i].qpos);
  }
  EXPECT_FALSE(fs::exists(path() + ".partial"));
}

/// Copies a dataset as it is.
void copy_dataset(const Hdf5File& from, Hdf5File& to, const DatasetSpec& spec) {
  to.create_dataset(spec);
  if (spec.row_shape == std::vector<std::size_t>{0}) {
    to.set_columns(spec.path, from.shape(spec.path)[1]);
  }
  switch (spec.type) {
    case DatasetSpec::Type::kFloat64:
      return to.append(spec.path, from.doubles(spec.path));
    case DatasetSpec::Type::kInt64:
      return to.append(spec.path, from.integers(spec.path));
    case DatasetSpec::Type::kText:
      return to.append(spec.path, from.texts(spec.path));
  }
}

/// Writes `old_file`: the trace in `file` without some datasets or the group /system, and with
/// another name for its outcome if one is given.
void copy_without(const std::string& file, const std::vector<std::string>& missing,
                  const std::string& old_file, const std::string& outcome = {}) {
  const Hdf5File written = Hdf5File::open(file);
  Hdf5File old = Hdf5File::create(old_file);
  old.set_integer("/", "schema", 1);
  for (const char* name : {"version", "scenario", "outcome", "fault"}) {
    old.set_text("/", name, written.text("/", name));
  }
  if (!outcome.empty()) old.set_text("/", "outcome", outcome);
  old.set_unsigned("/", "seed", written.unsigned_integer("/", "seed"));
  const Scenario scenario = parse_scenario(written.text("/", "scenario"));
  const models::SystemDescription system = read_system(written);
  if (std::ranges::find(missing, "/system") == missing.end()) write_system(old, system);
  for (const DatasetSpec& spec : trace_layout(scenario, system)) {
    if (std::ranges::find(missing, spec.path) == missing.end()) copy_dataset(written, old, spec);
  }
  old.close();
}

TEST_F(TraceFile, a_trace_from_before_the_newer_numbers_is_read_with_what_it_has) {
  const Trace trace = testing::example_trace();
  write_trace(path("new.h5"), trace);
  copy_without(path("new.h5"),
               {"/certificate/smoothed", "/certificate/dynamics", "/certificate/model",
                "/plan/gains", "/controller/believed"},
               path("old.h5"));
  const Trace read = read_trace(path("old.h5"));
  ASSERT_EQ(read.steps.size(), trace.steps.size());
  for (std::size_t k = 0; k < read.steps.size(); ++k) {
    StepRecord expected = trace.steps[k];
    expected.plan_gains.clear();
    expected.believed = std::numeric_limits<double>::quiet_NaN();
    for (controller::StageCertificate& stage : expected.certificates) {
      stage.figures[controller::certificate_index("c4")] = 1.0;
    }
    for (controller::StageBudget& stage : expected.budgets) {
      stage.dynamics = std::numeric_limits<double>::quiet_NaN();
      stage.model = 0.0;
    }
    testing::expect_same_step(read.steps[k], expected);
  }
}

TEST_F(TraceFile, a_trace_from_before_measurement_noise_is_of_a_planner_that_saw_the_state) {
  const Trace trace = testing::example_trace();
  write_trace(path("new.h5"), trace);
  copy_without(path("new.h5"), {"/plant/observation"}, path("old.h5"));
  const Trace read = read_trace(path("old.h5"));
  ASSERT_EQ(read.steps.size(), trace.steps.size());
  for (std::size_t k = 0; k < read.steps.size(); ++k) {
    EXPECT_FALSE(testing::same_bits(trace.steps[k].observation, trace.steps[k].state));
    StepRecord expected = trace.steps[k];
    expected.observation = expected.state;
    testing::expect_same_step(read.steps[k], expected);
  }
}

/// The reader's outcome of `trace` if it had been recorded with the outcome `recorded`.
Outcome outcome_read(const Trace& trace, const std::string& recorded, const std::string& file) {
  write_trace(file, trace);
  copy_without(file, {}, file + "-old.h5", recorded);
  return read_trace(file + "-old.h5").outcome;
}

TEST_F(TraceFile, the_old_outcome_name_for_unsafe_becomes_what_the_states_say) {
  Trace trace = testing::example_trace();
  EXPECT_THROW((void)outcome_read(trace, "left_safe_set", path()), InputError);
  trace.final_state = Eigen::Vector3d(3.0, 4.0, 0.0);  // in an obstacle
  EXPECT_EQ(outcome_read(trace, "left_safe_set", path()), Outcome::kCollision);
  trace.final_state = Eigen::Vector3d(3.0, -1.5, 0.0);
  EXPECT_EQ(outcome_read(trace, "left_safe_set", path()), Outcome::kLeftBounds);
  EXPECT_THROW((void)outcome_read(trace, "left_the_safe_set", path()), InputError);
}

TEST_F(TraceFile, an_old_drive_that_continued_after_an_unsafe_state_is_not_a_success_either) {
  Trace trace = testing::example_trace();
  EXPECT_EQ(outcome_read(trace, "timeout", path()), Outcome::kTimeout);
  EXPECT_EQ(outcome_read(trace, "reached", path()), Outcome::kReached);
  trace.steps[3].state = Eigen::Vector3d(12.5, 4.0, 0.0);  // out of the bounds
  trace.steps[4].state = Eigen::Vector3d(3.0, 4.0, 0.0);   // in an obstacle, but later
  EXPECT_EQ(outcome_read(trace, "reached", path()), Outcome::kLeftBounds);
  EXPECT_EQ(outcome_read(trace, "timeout", path()), Outcome::kLeftBounds);
  EXPECT_EQ(outcome_read(trace, "fault", path()), Outcome::kFault);
  EXPECT_EQ(outcome_read(trace, "interrupted", path()), Outcome::kInterrupted);
}

TEST_F(TraceFile, a_trace_from_before_the_description_gets_it_and_the_residuals_from_its_scenario) {
  const Trace trace = testing::example_trace();
  write_trace(path("new.h5"), trace);
  copy_without(path("new.h5"), {"/system", "/plant/residual"}, path("old.h5"));
  const Trace read = read_trace(path("old.h5"));
  testing::expect_same_system(read.system, trace.system);
  ASSERT_EQ(read.steps.size(), trace.steps.size());
  for (std::size_t k = 0; k < read.steps.size(); ++k) {
    testing::expect_same_step(read.steps[k], trace.steps[k]);
  }
}

TEST_F(TraceFile, residuals_are_the_recorded_ones_whatever_the_model_says) {
  Trace trace = testing::example_trace();
  trace.steps[2].residual << 7.0, 8.0, 9.0;
  write_trace(path(), trace);
  const Trace read = read_trace(path());
  EXPECT_EQ(EpisodeView(read).residuals().col(2), trace.steps[2].residual);
}

TEST_F(TraceFile, a_description_that_contradicts_the_scenario_or_itself_is_refused) {
  const auto refusal_of = [this](models::SystemDescription system) {
    Trace trace = testing::example_trace({.steps = 0});
    trace.system = std::move(system);
    trace.final_state.resize(0);
    write_trace(path(), trace);
    return refusal(path());
  };
  models::SystemDescription system = unlike_any_system();
  EXPECT_EQ(refusal_of(system), "");
  system.heading = 3;
  EXPECT_THAT(refusal_of(system), HasSubstr("/system@heading"));
  system = unlike_any_system();
  system.input_upper.setZero(2);
  EXPECT_THAT(refusal_of(system), HasSubstr("/system/inputs@upper"));
  system = unlike_any_system();
  system.position_x = -1;
  system.states.pop_back();
  EXPECT_THAT(refusal_of(system), HasSubstr("/system/states@names"));
}

TEST_F(TraceFile, an_episode_without_steps_and_one_without_a_mujoco_model_are_read_back) {
  Trace trace = testing::example_trace({.steps = 0});
  trace.motion.clear();
  write_trace(path("empty.h5"), trace);
  const Trace empty = read_trace(path("empty.h5"));
  EXPECT_TRUE(empty.steps.empty());
  EXPECT_TRUE(testing::same_bits(empty.final_state, trace.final_state));

  Trace analytic = testing::example_trace();
  for (MotionSample& sample : analytic.motion) sample.qpos.clear();
  write_trace(path("analytic.h5"), analytic);
  const Trace read = read_trace(path("analytic.h5"));
  ASSERT_EQ(read.motion.size(), analytic.motion.size());
  EXPECT_EQ(read.motion.back().time, analytic.motion.back().time);
  EXPECT_TRUE(read.motion.back().qpos.empty());
}

TEST_F(TraceFile, a_scenario_text_beyond_the_size_of_a_plain_attribute_is_kept) {
  Trace trace = testing::example_trace({.steps = 1});
  trace.scenario_text += "# " + std::string(200'000, 'x') + "\n";
  write_trace(path(), trace);
  EXPECT_EQ(read_trace(path()).scenario_text, trace.scenario_text);
}

TEST_F(TraceFile, every_dataset_names_its_units_and_every_axis) {
  const Trace trace = testing::example_trace();
  write_trace(path(), trace);
  const Hdf5File file = Hdf5File::open(path());
  for (const DatasetSpec& spec : trace_layout(trace.scenario, trace.system)) {
    EXPECT_TRUE(file.has_attribute(spec.path, "units")) << spec.path;
    EXPECT_TRUE(file.has_attribute(spec.path, "axes")) << spec.path;
    EXPECT_EQ(spec.axes.size(), file.shape(spec.path).size()) << spec.path;
    const std::size_t columns = spec.row_shape.empty() ? spec.chunk_rows : spec.row_shape.back();
    EXPECT_TRUE(spec.units.size() == 1 || spec.units.size() == columns) << spec.path;
  }
}

TEST_F(TraceFile, the_finished_file_is_closed_for_every_reader) {
  write_trace(path(), testing::example_trace());
  EXPECT_FALSE(Hdf5File::open(path()).left_open_by_writer());
  // Byte 11 of the superblock holds the flags of an open writer, which other programs refuse.
  EXPECT_EQ(bytes_of(path()).at(11), '\0');
}

TEST_F(TraceFile, equal_traces_give_equal_content_whatever_the_timings) {
  Trace trace = testing::example_trace({.steps = 40});
  write_trace(path("a.h5"), trace);
  write_trace(path("b.h5"), trace);
  const std::string a = content_of(path("a.h5"));
  EXPECT_TRUE(a == content_of(path("b.h5")));

  for (StepRecord& step : trace.steps) step.timing.total += 1.0;
  write_trace(path("c.h5"), trace);
  const std::string c = content_of(path("c.h5"));
  ASSERT_EQ(a.size(), c.size());
  std::size_t different = 0;
  for (std::size_t i = 0; i < a.size(); ++i) different += a[i] != c[i] ? 1 : 0;
  EXPECT_GT(different, 0U);
  EXPECT_LE(different, 40 * sizeof(double));
}

TEST_F(TraceFile, a_record_of_the_wrong_size_is_refused_before_anything_is_written) {
  const Trace trace = testing::example_trace();
  TraceWriter writer(path(), trace);
  StepRecord wrong = trace.steps[0];
  wrong.plan_states.conservativeResize(3, 2);
  EXPECT_THROW(writer.append(wrong, {}), std::invalid_argument);
  writer.append(trace.steps[0], {});
  writer.finish(trace);
  EXPECT_EQ(read_trace(path()).steps.size(), 1U);
}

TEST_F(TraceFile, threads_may_write_traces_at_the_same_time) {
  const Trace trace = testing::example_trace();
  std::vector<std::thread> threads;
  threads.reserve(4);
  for (int i = 0; i < 4; ++i) {
    threads.emplace_back(
        [&, i] { write_trace(path("episode" + std::to_string(i) + ".h5"), trace); });
  }
  for (std::thread& thread : threads) thread.join();
  const std::string first = content_of(path("episode0.h5"));
  for (int i = 1; i < 4; ++i) {
    EXPECT_TRUE(first == content_of(path("episode" + std::to_string(i) + ".h5"))) << i;
  }
}

TEST(OutcomeName, every_outcome_has_a_name_that_leads_back_to_it) {
  for (const Outcome outcome : {Outcome::kReached, Outcome::kCollision, Outcome::kLeftBounds,
                                Outcome::kTimeout, Outcome::kFault, Outcome::kInterrupted}) {
    EXPECT_EQ(outcome_from_name(outcome_name(outcome)), outcome);
  }
  EXPECT_EQ(outcome_list(), "reached, collision, left_bounds, timeout, fault, interrupted");
  EXPECT_THROW(static_cast<void>(outcome_from_name("won")), std::invalid_argument);
}

}  // namespace trace_file_test
}  // namespace qsmpc::harness
