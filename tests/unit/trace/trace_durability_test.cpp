// What a kill, a full disk or damage leaves of a trace, and how it is reported.
#include <array>
#include <csignal>
#include <filesystem>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "harness/errors.hpp"
#include "harness/trace/trace_file.hpp"
#include "harness/trace/trace_writer.hpp"
#include "tests/support/example_trace.hpp"
#include "tests/unit/trace/trace_folder.hpp"
#include "tests/unit/trace/trace_matchers.hpp"

namespace qsmpc::harness {
namespace trace_durability_test {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

class TraceDurability : public testing::TraceFolder {};

TEST_F(TraceDurability, a_killed_run_leaves_every_step_that_was_appended) {
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

TEST_F(TraceDurability, a_run_that_is_killed_at_any_moment_leaves_a_readable_file) {
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

TEST_F(TraceDurability, a_writer_that_is_given_up_leaves_the_partial_file_and_the_old_result) {
  const Trace trace = testing::example_trace();
  write_bytes(path(), "an older result");
  {
    TraceWriter writer(path(), trace);
    writer.append(trace.steps[0], {});
  }
  EXPECT_EQ(bytes_of(path()), "an older result");
  EXPECT_EQ(read_trace(path() + ".partial").steps.size(), 1U);
}

TEST_F(TraceDurability, a_path_that_cannot_be_written_is_named_with_the_systems_message) {
  const Trace trace = testing::example_trace({.steps = 1});
  try {
    write_trace(path("no/such/folder/episode.h5"), trace);
    FAIL() << "no error";
  } catch (const IoError& error) {
    EXPECT_THAT(error.what(), HasSubstr("no/such/folder/episode.h5"));
    EXPECT_THAT(error.what(), HasSubstr("No such file or directory"));
  }
}

TEST_F(TraceDurability, a_name_that_is_taken_by_a_folder_is_an_error_at_the_end) {
  fs::create_directories(path() + "/occupied");
  EXPECT_THROW(write_trace(path(), testing::example_trace({.steps = 1})), IoError);
}

/// The exit code of `write_trace` in a process whose files are limited to `limit` bytes; 0: it
/// threw an IoError with path and reason, and the process then exited normally.
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
    std::exit(code);  // with exit handlers: HDF5's must not hang or crash on the partial file
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

TEST_F(TraceDurability, a_disk_that_is_full_is_an_error_at_whatever_size_it_comes) {
  // From the header alone, through the datasets, to the middle of the particles.
  for (const rlim_t limit : {1, 1000, 5000, 20'000, 50'000, 100'000, 200'000, 400'000}) {
    EXPECT_EQ(outcome_of_a_full_disk(path(), limit), 0) << limit;
    EXPECT_FALSE(fs::exists(path()));
  }
}

TEST_F(TraceDurability, files_that_are_not_traces_are_refused_by_name) {
  EXPECT_THAT(refusal(path("missing.h5")), HasSubstr("missing.h5: found no file"));
  EXPECT_THAT(refusal(folder_.path()), HasSubstr("found a folder"));
  write_bytes(path("text.h5"), "name: dubins\n");
  EXPECT_THAT(refusal(path("text.h5")), HasSubstr("found a file that is not HDF5"));
  write_bytes(path("empty.h5"), "");
  EXPECT_THAT(refusal(path("empty.h5")), HasSubstr("found a file that is not HDF5"));
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

TEST_F(TraceDurability, a_trace_cut_at_any_length_is_refused) {
  write_trace(path(), testing::example_trace());
  const std::string whole = bytes_of(path());
  for (std::size_t length = 0; length < whole.size(); length += whole.size() / 50) {
    write_bytes(path("cut.h5"), whole.substr(0, length));
    EXPECT_NE(refusal(path("cut.h5")), "") << length << " of " << whole.size();
  }
}

TEST_F(TraceDurability, a_damaged_partial_file_is_refused_at_once) {
  const Trace trace = testing::example_trace();
  {
    TraceWriter writer(path(), trace);
    writer.append(trace.steps[0], trace.motion);
    fs::copy_file(path() + ".partial", path("killed.h5"));
  }
  ASSERT_EQ(read_trace(path("killed.h5")).steps.size(), 1U);
  std::string damaged = bytes_of(path("killed.h5"));
  constexpr std::size_t kRootAddress = 36;  // in the superblock, which is protected by a checksum
  damaged[kRootAddress] = static_cast<char>(damaged[kRootAddress] ^ 0x55);
  write_bytes(path("killed.h5"), damaged);
  EXPECT_THAT(refusal(path("killed.h5")), HasSubstr("an undamaged trace"));
}

TEST_F(TraceDurability, a_damaged_trace_is_read_or_refused_and_never_anything_else) {
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
}  // namespace trace_durability_test
}  // namespace qsmpc::harness
