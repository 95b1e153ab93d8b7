// The processes of external controllers: start, termination and output.
#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <thread>
#include <vector>

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "harness/control/child_process.hpp"
#include "harness/episode/episode.hpp"
#include "harness/trace/trace.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/unit/control/outside_fixture.hpp"

namespace qsmpc::harness {
namespace outside_process_test {

using ::testing::HasSubstr;

Trace failed(const std::string& mode, const std::vector<std::string>& more = {}) {
  std::vector<std::string> overrides = {"controller.options.mode=" + mode};
  overrides.insert(overrides.end(), more.begin(), more.end());
  return run_episode(outside_scenario(OutsideKind::kExternal, overrides), {.seed = 1});
}

TEST(OutsideProcess, invalid_answers_are_reported_with_what_was_found) {
  const std::vector<std::pair<std::string, std::string>> modes = {
      {"text", "found an answer that is not JSON: steer straight on, expected {\"input\": […]}"},
      {"list", "found the answer [0.0]"},
      {"other", "found the answer {\"output\":[0.0]}"},
      {"word", "found input [\"0\"], expected 1 finite numbers"},
      {"period", "found an answer for period 1, expected one for period 2"},
      {"silence", "found an answer that is not JSON: "},
      {"long", "found a line of more than 16777216 bytes"},
      {"half", "found an exit with code 0"}};
  for (const auto& [mode, reason] : modes) {
    SCOPED_TRACE(mode);
    const Trace trace = failed(mode);
    EXPECT_EQ(trace.fault_of, FaultOf::kController);
    EXPECT_THAT(trace.fault, HasSubstr("responder.py: period 2: "));
    EXPECT_THAT(trace.fault, HasSubstr(reason));
    EXPECT_EQ(trace.steps.size(), 2U);
  }
}

TEST(OutsideProcess, answers_that_nothing_had_asked_for_end_the_drive) {
  const Trace twice = failed("twice");
  EXPECT_THAT(twice.fault, HasSubstr("an unrequested answer"));
  EXPECT_EQ(twice.steps.size(), 3U);
  // Reported before the first period if it has arrived by then, else instead of a later answer.
  const Trace early = failed("early");
  EXPECT_EQ(early.outcome, Outcome::kFault);
  EXPECT_LE(early.steps.size(), 2U);
}

TEST(OutsideProcess, what_reads_nothing_any_more_is_not_waited_for_longer_than_the_deadline) {
  const Trace trace = failed("deaf", {"controller.deadline=1"});
  EXPECT_EQ(trace.fault_of, FaultOf::kController);
  EXPECT_EQ(trace.steps.size(), 3U);
  EXPECT_THAT(trace.fault, HasSubstr("period 3"));
}

/// Processor time of all processes that this one started and that have ended, s.
double time_of_children() {
  rusage usage{};
  EXPECT_EQ(::getrusage(RUSAGE_CHILDREN, &usage), 0);
  const auto seconds = [](const timeval& time) {
    return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
  };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

// Processor time, unlike the duration, does not depend on what else is running.
TEST(OutsideProcess, is_waited_for_without_keeping_a_processor_busy) {
  const double before = time_of_children();
  EXPECT_THAT(failed("hang", {"controller.deadline=3"}).fault, HasSubstr("no answer within 3 s"));
  EXPECT_LT(time_of_children() - before, 1.5);
}

TEST(OutsideProcess, that_does_not_begin_is_a_fault_of_the_controller) {
  EXPECT_THAT(failed("old").fault,
              HasSubstr("found version 7 of the protocol, expected version 1"));
  EXPECT_THAT(failed("no_greeting", {"controller.start_deadline=1"}).fault,
              HasSubstr("its start: found no answer within 1 s"));
  Scenario gone = outside_scenario(OutsideKind::kExternal);
  gone.controller.outside.command = {"./no_such_program"};
  EXPECT_THAT(run_episode(gone, {}).fault,
              HasSubstr("a process that cannot be started: No such file or directory"));
  gone.controller.outside.folder = "/no/such/folder";
  EXPECT_THAT(run_episode(gone, {}).fault, HasSubstr("No such file or directory"));
}

TEST(OutsideProcess, reports_why_a_library_does_not_start) {
  for (const OutsideKind kind : {OutsideKind::kLibrary, OutsideKind::kOwnClass}) {
    const Scenario scenario = outside_scenario(kind, {"controller.options.mode=no_start"});
    const Trace trace = run_episode(scenario, {});
    EXPECT_TRUE(trace.steps.empty());
    EXPECT_THAT(trace.fault, HasSubstr("its start: found its error: no horizon of "));
  }
  Scenario scenario = outside_scenario(OutsideKind::kLibrary);
  std::string& library = scenario.controller.outside.library;
  library = library_file("other_version");
  EXPECT_THAT(run_episode(scenario, {}).fault,
              HasSubstr("has version 2 of the controller interface; this program has version 1"));
  library = data_folder() + "/responder.py";
  EXPECT_THAT(run_episode(scenario, {}).fault, HasSubstr("its error: "));
  library = "libm.so.6";
  EXPECT_THAT(run_episode(scenario, {}).fault,
              HasSubstr("does not export the function qsmpc_controller"));
}

TEST(OutsideProcess, has_its_standard_error_in_the_log_and_its_last_line_in_the_reason) {
  const Trace trace = failed("exit");
  EXPECT_THAT(trace.fault, HasSubstr("after \"ZeroDivisionError: division by zero\""));
  EXPECT_EQ(trace.controller_log,
            "controller of dubins_obstacles\ndrive 1\nTraceback\nZeroDivisionError: division by "
            "zero\n");
  const Scenario scenario = outside_scenario(OutsideKind::kLibrary);
  EXPECT_THAT(run_episode(scenario, {}).controller_log,
              HasSubstr("what a library prints is in the log\n"));
}

/// The process ids written by a responder with the option `pids`.
std::vector<pid_t> written_pids(const std::string& path) {
  std::ifstream file(path);
  return {std::istream_iterator<pid_t>(file), {}};
}

bool is_there(pid_t process) { return ::kill(process, 0) == 0; }

TEST(OutsideProcess, ends_with_all_of_its_children_however_the_drive_ends) {
  for (const char* mode : {"good", "crash", "hang", "stubborn", "exit", "no_greeting"}) {
    SCOPED_TRACE(mode);
    const testing::TemporaryFolder folder;
    const std::string pids = folder / "pids";
    (void)failed(mode, {"controller.options.pids=" + pids, "controller.deadline=1",
                        "controller.start_deadline=3"});
    const std::vector<pid_t> started = written_pids(pids);
    ASSERT_EQ(started.size(), 2U);
    for (const pid_t process : started) EXPECT_FALSE(is_there(process));
    EXPECT_EQ(::waitpid(-1, nullptr, WNOHANG), -1) << "a zombie";
  }
}

TEST(OutsideProcess, has_no_descriptor_of_the_programs_but_its_own_three) {
  const testing::TemporaryFolder folder;
  const int inherited = ::open("/dev/null", O_RDONLY);  // without O_CLOEXEC, as some libraries do
  (void)failed("good", {"controller.options.descriptors=" + (folder / "list")});
  ::close(inherited);
  std::ifstream file(folder / "list");
  std::string line;
  std::getline(file, line);
  EXPECT_EQ(line, "0 1 2");
}

void wait_for_end(const std::vector<pid_t>& processes) {
  const auto until = std::chrono::steady_clock::now() + std::chrono::seconds(30);
  for (const pid_t process : processes) {
    while (is_there(process) && std::chrono::steady_clock::now() < until) {
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    EXPECT_FALSE(is_there(process));
  }
}

TEST(OutsideProcess, that_left_after_its_last_answer_is_started_again_for_the_next_drive) {
  const testing::TemporaryFolder folder;
  const std::string pids = folder / "pids";
  const Scenario scenario =
      outside_scenario(OutsideKind::kExternal,
                       {"controller.options.mode=leaves", "controller.options.pids=" + pids});
  EpisodeDriver driver(scenario);
  for (const std::size_t drives : {1U, 2U}) {
    const Trace trace = driver.run({.seed = drives});
    EXPECT_EQ(trace.outcome, Outcome::kTimeout) << trace.fault;
    EXPECT_EQ(trace.steps.size(), 6U);
    const std::vector<pid_t> started = written_pids(pids);
    EXPECT_EQ(started.size(), 2 * drives);
    wait_for_end(started);
  }
}

TEST(OutsideProcess, leaves_no_descriptor_open) {
  const auto open_descriptors = [] {
    return std::distance(std::filesystem::directory_iterator("/proc/self/fd"), {});
  };
  (void)failed("good");
  const auto before = open_descriptors();
  for (const char* mode : {"good", "crash", "old"}) (void)failed(mode);
  EXPECT_EQ(open_descriptors(), before);
}

TEST(OutsideProcess, ends_with_its_children_where_the_program_is_killed) {
  const testing::TemporaryFolder folder;
  const std::string pids = folder / "pids";
  const pid_t program = ::fork();
  ASSERT_GE(program, 0);
  if (program == 0) {
    (void)failed("hang", {"controller.options.pids=" + pids, "controller.deadline=600"});
    ::_exit(0);
  }
  std::vector<pid_t> started;
  while (started.size() < 2) started = written_pids(pids);
  ::kill(program, SIGKILL);
  ::waitpid(program, nullptr, 0);
  wait_for_end(started);
}

}  // namespace outside_process_test
}  // namespace qsmpc::harness
