// A process that is told lines and answers lines, and ends with all of its children when its owner
// wants it or ends itself.
//
//   ChildProcess child({"folder", "run", "python3", "my.py"});
//   child.send("{}", deadline);
//   child.receive(deadline);   // "…"
//
// It runs under qsmpc-host (host/main.cpp). No call waits longer than it is told to, but for
// signals to stop (check_interrupts), which end it earlier.
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

/// The process is not there any more, or says too much. `what()` in the words of an error's found.
class ChildFailure : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

class ChildProcess {
 public:
  using Clock = std::chrono::steady_clock;

  /// Starts the host with these arguments. Throws IoError where it cannot be started.
  explicit ChildProcess(const std::vector<std::string>& host_arguments);
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;
  ChildProcess(ChildProcess&&) = delete;
  ChildProcess& operator=(ChildProcess&&) = delete;
  /// Ends it and its children: asks them to, and kills what has not gone after a second.
  ~ChildProcess();

  /// Writes `line` and a new line. Returns whether it was read so far by `deadline` that all of it
  /// could be written. Throws ChildFailure, and Interrupted.
  [[nodiscard]] bool send(const std::string& line, Clock::time_point deadline);

  /// The next line, without its end; nothing if there is none by `deadline`. Throws ChildFailure,
  /// and Interrupted.
  [[nodiscard]] std::optional<std::string> receive(Clock::time_point deadline);

  /// What it has said by now that nobody has received; nothing where that is nothing.
  [[nodiscard]] std::optional<std::string> unasked();

  /// Reads what of its standard error has come by now.
  void listen() { turn(Clock::time_point::min()); }

  /// Whether it still can answer, as far as is known by now.
  [[nodiscard]] bool is_alive() const { return !end_ && output_.is_open() && leash_.is_open(); }

  /// Sends `line`, closes its standard input and gives it a second to end by itself.
  void finish(const std::string& line) noexcept;

  /// Its standard error so far, which the caller may clear.
  [[nodiscard]] BoundedLog& log() { return log_; }
  /// Waits a little for the last words of a process that has ended.
  void read_last_words();

 private:
  /// Moves what can be moved, waiting for it until `until` at most.
  void turn(Clock::time_point until);
  void write_some();
  void read_output();
  void read_errors();
  void read_leash();
  [[nodiscard]] std::optional<std::string> take_line();
  /// Throws ChildFailure where nothing more can come.
  void check_alive() const;
  void end_host() noexcept;

  pid_t host_ = -1;
  Descriptor input_;   // of the process, to be written
  Descriptor output_;  // of the process, to be read; closed at its end, as the next ones
  Descriptor errors_;
  Descriptor leash_;
  std::string to_write_;
  std::string received_;
  std::size_t searched_ = 0;  // bytes of it that have no new line
  std::optional<ChildEnd> end_;
  BoundedLog log_;
};

}  // namespace qsmpc::harness
