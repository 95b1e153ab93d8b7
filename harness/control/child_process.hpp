// A process that exchanges lines with its owner; it and all of its children are ended on request or
// when the owner ends.
//
//   ChildProcess child({"folder", "run", "python3", "my.py"});
//   child.send("{}", deadline);
//   child.receive(deadline);   // "…"
//
// It runs under qsmpc-host (host/main.cpp). No call blocks beyond its deadline; stop signals
// (check_interrupts) end it earlier.
#pragma once

#include <chrono>
#include <cstddef>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include <sys/types.h>

#include "harness/control/bounded_log.hpp"
#include "harness/control/descriptor.hpp"
#include "harness/control/host/child_end.hpp"

namespace qsmpc::harness {

/// The process has ended, or its output is too long. `what()` is worded as an error's "found".
class ChildFailure : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

class ChildProcess {
 public:
  using Clock = std::chrono::steady_clock;

  /// Starts the host with these arguments. Throws IoError where that fails.
  explicit ChildProcess(const std::vector<std::string>& host_arguments);
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;
  ChildProcess(ChildProcess&&) = delete;
  ChildProcess& operator=(ChildProcess&&) = delete;
  /// Ends the process and its children: asks them to end, and kills those left after a second.
  ~ChildProcess();

  /// Writes `line` and a line feed. Returns whether all of it could be written by `deadline`, i.e.
  /// whether the process reads fast enough. Throws ChildFailure, and Interrupted.
  [[nodiscard]] bool send(const std::string& line, Clock::time_point deadline);

  /// The next line, without its line feed; nothing if there is none by `deadline`. Throws
  /// ChildFailure, and Interrupted.
  [[nodiscard]] std::optional<std::string> receive(Clock::time_point deadline);

  /// Output so far that has not been received; nothing if there is none.
  [[nodiscard]] std::optional<std::string> unasked();

  /// Reads the standard error that is available.
  void listen() { turn(Clock::time_point::min()); }

  /// Whether the process can still answer, as far as is known.
  [[nodiscard]] bool is_alive() const { return !end_ && output_.is_open() && leash_.is_open(); }

  /// Sends `line`, closes the process's standard input and gives it a second to end by itself.
  void finish(const std::string& line) noexcept;

  /// The process's standard error so far, which the caller may clear.
  [[nodiscard]] BoundedLog& log() { return log_; }
  /// Waits briefly for the remaining output of a process that has ended.
  void read_last_words();

 private:
  /// Transfers pending data in both directions, waiting for it until `until` at most.
  void turn(Clock::time_point until);
  void write_some();
  void read_output();
  void read_errors();
  void read_leash();
  [[nodiscard]] std::optional<std::string> take_line();
  /// Throws ChildFailure where no more output can come.
  void check_alive() const;
  void end_host() noexcept;

  pid_t host_ = -1;
  Descriptor input_;   // the process's standard input
  Descriptor output_;  // the process's standard output; closed at its end, like those below
  Descriptor errors_;
  Descriptor leash_;
  std::string to_write_;
  std::string received_;
  std::size_t searched_ = 0;  // bytes of it known to contain no line feed
  std::optional<ChildEnd> end_;
  BoundedLog log_;
};

}  // namespace qsmpc::harness
