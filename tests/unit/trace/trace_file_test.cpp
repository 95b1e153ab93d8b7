#include "harness/trace/trace_file.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "harness/errors.hpp"
#include "harness/trace/trace_layout.hpp"
#include "tests/support/example_trace.hpp"
#include "tests/unit/trace/trace_matchers.hpp"

#ifdef __SANITIZE_ADDRESS__
// HDF5 itself leaks where it gives a damaged file or a full disk up.
// NOLINTNEXTLINE(bugprone-reserved-identifier,readability-identifier-naming)
extern "C" const char* __lsan_default_suppressions() { return "leak:libhdf5"; }
#endif

namespace qsmpc::harness {
namespace trace_file_test {

namespace fs = std::filesystem;
using testing::example_trace;
using testing::expect_same_step;
using ::testing::HasSubstr;
using testing::same_bits;

class TraceFile : public ::testing::Test {
 protected:
  TraceFile() {
    std::string name = ::testing::TempDir() + "trace_XXXXXX";
    folder_ = ::mkdtemp(name.data());
  }
  ~TraceFile() override { fs::remove_all(folder_); }

  [[nodiscard]] std::string path(const std::string& name = "episode.h5") const {
    return folder_ + "/" + name;
  }
  [[nodiscard]] static std::string bytes_of(const std::string& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
  }
  /// All bytes after the superblock and its extension, in which HDF5 keeps, unasked, the second in
  /// which the file was made.
  [[nodiscard]] static std::string content_of(const std::string& file) {
    constexpr std::size_t kHeader = 108;
    return bytes_of(file).substr(kHeader);
  }
  static void write_bytes(const std::string& file, const std::string& bytes) {
    std::ofstream(file, std::ios::binary) << bytes;
  }
  /// What `read_trace` says of a file that it refuses as bad input.
  [[nodiscard]] static std::string refusal(const std::string& file) {
    try {
      static_cast<void>(read_trace(file));
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }

  std::string folder_;
};

TEST_F(TraceFile, reading_gives_back_what_was_written_bit_for_bit) {
  Trace trace = testing::example_trace();
  trace.fault = "it said \"bang\" — and stopped";
  trace.outcome = Outcome::kFault;
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

/// Writes `old`: the trace in `file` without some datasets.
void copy_without(const std::string& file, const std::vector<std::string>& missing,
                  const std::string& old_file) {
  const Hdf5File written = Hdf5File::open(file);
  Hdf5File old = Hdf5File::create(old_file);
  old.set_integer("/", "schema", 1);
  for (const char* name : {"version", "scenario", "outcome", "fault"}) {
    old.set_text("/", name, written.text("/", name));
  }
  old.set_unsigned("/", "seed", written.unsigned_integer("/", "seed"));
  const Scenario scenario = parse_scenario(written.text("/", "scenario"));
  for (const DatasetSpec& spec : trace_layout(scenario)) {
    if (std::ranges::find(missing, spec.path) == missing.end()) copy_dataset(written, old, spec);
  }
  old.close();
}

TEST_F(TraceFile, a_trace_from_before_the_newer_numbers_is_read_with_what_it_has) {
  const Trace trace = testing::example_trace();
  write_trace(path("new.h5"), trace);
  copy_without(path("new.h5"),
               {"/certificate/smoothed", "/certificate/dynamics", "/certificate/model"},
               path("old.h5"));
  const Trace read = read_trace(path("old.h5"));
  ASSERT_EQ(read.steps.size(), trace.steps.size());
  for (std::size_t k = 0; k < read.steps.size(); ++k) {
    StepRecord expected = trace.steps[k];
    for (controller::StageCertificate& stage : expected.certificates) stage.smoothed = 1.0;
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

TEST_F(TraceFile, every_dataset_says_its_units_and_names_every_axis) {
  const Trace trace = testing::example_trace();
  write_trace(path(), trace);
  const Hdf5File file = Hdf5File::open(path());
  for (const DatasetSpec& spec : trace_layout(trace.scenario)) {
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
  // Byte 11 of the superblock holds the flags of an open writer; other programs refuse on them.
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

TEST_F(TraceFile, a_killed_run_leaves_every_step_that_was_appended) {
  const Trace trace = testing::example_trace({.steps = 30});
  const pid_t child = ::fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    TraceWriter writer(path(), trace);
    for (const StepRecord& step : trace.steps) writer.append(step, trace.motion);
    ::raise(SIGKILL);
  }
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  ASSERT_TRUE(WIFSIGNALED(status));

  EXPECT_FALSE(fs::exists(path()));
  const Trace read = read_trace(path() + ".partial");
  EXPECT_EQ(read.outcome, Outcome::kInterrupted);
  EXPECT_EQ(read.final_state.size(), 0);
  ASSERT_EQ(read.steps.size(), trace.steps.size());
  for (std::size_t k = 0; k < read.steps.size(); ++k) {
    testing::expect_same_step(read.steps[k], trace.steps[k]);
  }
}

TEST_F(TraceFile, a_run_that_is_killed_at_any_moment_leaves_a_readable_file) {
  const Trace trace = testing::example_trace({.steps = 20});
  for (const std::size_t before : {0, 1, 2, 5, 11, 19, 37}) {
    std::array<int, 2> pipe{};
    ASSERT_EQ(::pipe(pipe.data()), 0);
    const pid_t child = ::fork();
    ASSERT_GE(child, 0);
    if (child == 0) {
      TraceWriter writer(path(), trace);
      for (std::size_t k = 0;; ++k) {
        if (k == before && ::write(pipe[1], "x", 1) != 1) ::_exit(1);
        writer.append(trace.steps[k % trace.steps.size()], trace.motion);
      }
    }
    char sign = 0;
    ASSERT_EQ(::read(pipe[0], &sign, 1), 1);
    ASSERT_EQ(::kill(child, SIGKILL), 0);
    ASSERT_EQ(::waitpid(child, nullptr, 0), child);
    ::close(pipe[0]);
    ::close(pipe[1]);

    const Trace read = read_trace(path() + ".partial");
    EXPECT_GE(read.steps.size(), before);
    for (std::size_t k = 0; k < read.steps.size(); ++k) {
      testing::expect_same_step(read.steps[k], trace.steps[k % trace.steps.size()]);
    }
  }
}

TEST_F(TraceFile, a_writer_that_is_given_up_leaves_the_partial_file_and_the_old_result) {
  const Trace trace = testing::example_trace();
  write_bytes(path(), "an older result");
  {
    TraceWriter writer(path(), trace);
    writer.append(trace.steps[0], {});
  }
  EXPECT_EQ(bytes_of(path()), "an older result");
  EXPECT_EQ(read_trace(path() + ".partial").steps.size(), 1U);
}

TEST_F(TraceFile, a_path_that_cannot_be_written_is_named_with_the_systems_words) {
  const Trace trace = testing::example_trace({.steps = 1});
  try {
    write_trace(path("no/such/folder/episode.h5"), trace);
    FAIL() << "no error";
  } catch (const IoError& error) {
    EXPECT_THAT(error.what(), HasSubstr("no/such/folder/episode.h5"));
    EXPECT_THAT(error.what(), HasSubstr("No such file or directory"));
  }
}

TEST_F(TraceFile, a_name_that_is_taken_by_a_folder_is_an_error_at_the_end) {
  fs::create_directories(path() + "/occupied");
  EXPECT_THROW(write_trace(path(), testing::example_trace({.steps = 1})), IoError);
}

/// What `write_trace` does in a process whose files may not grow beyond `limit` bytes; 0: it threw
/// an IoError that names the path and the reason, and the process then ended as usual.
int outcome_of_a_full_disk(const std::string& file, rlim_t limit) {
  const pid_t child = ::fork();
  if (child == 0) {
    ::signal(SIGXFSZ, SIG_IGN);
    const rlimit size{.rlim_cur = limit, .rlim_max = limit};
    ::setrlimit(RLIMIT_FSIZE, &size);
    int code = 1;
    try {
      write_trace(file, testing::example_trace({.steps = 60, .points = 100}));
    } catch (const IoError& error) {
      const std::string text = error.what();
      const bool says_why =
          text.find(file) != std::string::npos && text.find("File too large") != std::string::npos;
      code = says_why ? 0 : 2;
    }
    std::exit(code);  // with the exit handlers: HDF5's own must not hang or crash on what is left
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

TEST_F(TraceFile, a_disk_that_is_full_is_an_error_at_whatever_size_it_comes) {
  // From the header alone, over the datasets, to the middle of the particles.
  for (const rlim_t limit : {1, 1000, 5000, 20'000, 50'000, 100'000, 200'000, 400'000}) {
    EXPECT_EQ(outcome_of_a_full_disk(path(), limit), 0) << limit;
    EXPECT_FALSE(fs::exists(path()));
  }
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

TEST_F(TraceFile, files_that_are_no_traces_are_refused_by_name) {
  EXPECT_THAT(refusal(path("missing.h5")), HasSubstr("missing.h5: found no file"));
  EXPECT_THAT(refusal(folder_), HasSubstr("found a folder"));
  write_bytes(path("text.h5"), "name: dubins\n");
  EXPECT_THAT(refusal(path("text.h5")), HasSubstr("found no HDF5 file"));
  write_bytes(path("empty.h5"), "");
  EXPECT_THAT(refusal(path("empty.h5")), HasSubstr("found no HDF5 file"));
  {
    Hdf5File foreign = Hdf5File::create(path("foreign.h5"));
    foreign.create_dataset({.path = "/measurements", .axes = {"i"}, .units = {"V"}});
    foreign.close();
  }
  EXPECT_THAT(refusal(path("foreign.h5")), HasSubstr("expected a trace of schema 1"));
  {
    Hdf5File later = Hdf5File::create(path("later.h5"));
    later.set_integer("/", "schema", 2);
    later.close();
  }
  EXPECT_THAT(refusal(path("later.h5")), HasSubstr("found schema 2, expected a trace of schema 1"));
}

TEST_F(TraceFile, a_trace_cut_at_any_length_is_refused) {
  write_trace(path(), testing::example_trace());
  const std::string whole = bytes_of(path());
  for (std::size_t length = 0; length < whole.size(); length += whole.size() / 50) {
    write_bytes(path("cut.h5"), whole.substr(0, length));
    EXPECT_NE(refusal(path("cut.h5")), "") << length << " of " << whole.size();
  }
}

TEST_F(TraceFile, a_damaged_partial_file_is_refused_at_once) {
  const Trace trace = testing::example_trace();
  {
    TraceWriter writer(path(), trace);
    writer.append(trace.steps[0], trace.motion);
    fs::copy_file(path() + ".partial", path("killed.h5"));
  }
  ASSERT_EQ(read_trace(path("killed.h5")).steps.size(), 1U);
  std::string damaged = bytes_of(path("killed.h5"));
  constexpr std::size_t kRootAddress = 36;  // in the superblock, which has a checksum
  damaged[kRootAddress] = static_cast<char>(damaged[kRootAddress] ^ 0x55);
  write_bytes(path("killed.h5"), damaged);
  EXPECT_THAT(refusal(path("killed.h5")), HasSubstr("a trace that is not damaged"));
}

TEST_F(TraceFile, a_damaged_trace_is_read_or_refused_and_never_anything_else) {
  write_trace(path(), testing::example_trace({.steps = 2}));
  const std::string whole = bytes_of(path());
  std::size_t refused = 0;
  for (std::size_t at = 0; at < whole.size(); at += 97) {
    std::string damaged = whole;
    damaged[at] = static_cast<char>(damaged[at] ^ 0x55);
    write_bytes(path("damaged.h5"), damaged);
    refused += refusal(path("damaged.h5")).empty() ? 0 : 1;
  }
  EXPECT_GT(refused, 0U);
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
  for (const Outcome outcome : {Outcome::kReached, Outcome::kTimeout, Outcome::kLeftSafeSet,
                                Outcome::kFault, Outcome::kInterrupted}) {
    EXPECT_EQ(outcome_from_name(outcome_name(outcome)), outcome);
  }
  EXPECT_THROW(static_cast<void>(outcome_from_name("won")), std::invalid_argument);
}

}  // namespace trace_file_test
}  // namespace qsmpc::harness
